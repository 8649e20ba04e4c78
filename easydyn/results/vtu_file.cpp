#include "easydyn/results/vtu_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <fstream>

#include "easydyn/error.hpp"
#include "easydyn/results/pending_file.hpp"

namespace easydyn::results {
namespace {

constexpr int vtk_quad = 9;

const char* byte_order() {
  return std::endian::native == std::endian::little ? "LittleEndian" : "BigEndian";
}

std::size_t base64_size(std::size_t bytes) {
  return (bytes + 2) / 3 * 4;
}

// RFC 4648.
void add_base64(std::string& out, const std::string& bytes) {
  static constexpr char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t left = bytes.size() - i;
    const auto byte = [&](std::size_t k) {
      return k < left ? static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[i + k])) : 0u;
    };
    const std::uint32_t three = byte(0) << 16 | byte(1) << 8 | byte(2);
    out += digits[three >> 18];
    out += digits[three >> 12 & 63];
    out += left > 1 ? digits[three >> 6 & 63] : '=';
    out += left > 2 ? digits[three & 63] : '=';
  }
}

// The array as VTK wants it: its length in bytes, then the numbers, both in one run of base64.
template <class T>
void add_array(std::string& out, const std::vector<T>& values) {
  const std::uint64_t size = values.size() * sizeof(T);
  std::string bytes(sizeof size + size, '\0');
  std::memcpy(bytes.data(), &size, sizeof size);
  if (size > 0) std::memcpy(bytes.data() + sizeof size, values.data(), size);
  add_base64(out, bytes);
}

std::string escape(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '&') {
      out += "&amp;";
    } else if (c == '<') {
      out += "&lt;";
    } else if (c == '>') {
      out += "&gt;";
    } else if (c == '"') {
      out += "&quot;";
    } else {
      out += c;
    }
  }
  return out;
}

void check(const QuadMesh& mesh, const std::vector<PointVectors>& vectors) {
  const auto check_values = [](const std::string& name, const std::vector<float>& values) {
    const auto bad = std::find_if(values.begin(), values.end(), [](float v) { return !std::isfinite(v); });
    if (bad != values.end()) {
      throw ModelError(fmt::format("snapshot: {} of point {} is {}, must be finite", name,
                                   (bad - values.begin()) / 3, *bad));
    }
  };
  check_values("position", mesh.points);
  for (const PointVectors& v : vectors) {
    if (v.values.size() != mesh.points.size()) {
      throw ModelError(fmt::format("snapshot: {} has {} numbers, must have {}", v.name, v.values.size(),
                                   mesh.points.size()));
    }
    check_values(v.name, v.values);
  }
}

void write_text(const std::filesystem::path& path, const std::string& text) {
  PendingFile pending(path);
  std::ofstream file(pending.partial_path(), std::ios::binary);
  file.write(text.data(), static_cast<std::streamsize>(text.size()));
  file.close();
  if (!file) {
    throw InputError(fmt::format("{}: cannot be written: is the disk full?", path.string()));
  }
  pending.commit();
}

}  // namespace

void write_vtu(const std::filesystem::path& path, const QuadMesh& mesh,
               const std::vector<PointVectors>& vectors, double time) {
  check(mesh, vectors);
  std::string head = fmt::format(
      "<?xml version=\"1.0\"?>\n"
      "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"{}\" header_type=\"UInt64\">\n"
      "<UnstructuredGrid>\n"
      "<FieldData><DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" "
      "format=\"ascii\">{}</DataArray></FieldData>\n"
      "<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n",
      byte_order(), time, mesh.point_count(), mesh.quad_count());
  std::string data;
  data.reserve(
      static_cast<std::size_t>(compute_vtu_size(mesh.point_count(), mesh.quad_count(), vectors.size())));
  const auto add = [&](const char* type, const std::string& name, int components, const auto& values) {
    head += fmt::format(
        "<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"appended\" offset=\"{}\"/>\n",
        type, escape(name), components, data.size());
    add_array(data, values);
  };
  head += "<PointData>\n";
  for (const PointVectors& v : vectors) add("Float32", v.name, 3, v.values);
  head += "</PointData>\n<Points>\n";
  add("Float32", "Points", 3, mesh.points);
  head += "</Points>\n<Cells>\n";
  std::vector<std::int32_t> ends(mesh.quad_count());
  for (std::size_t q = 0; q < ends.size(); ++q) ends[q] = static_cast<std::int32_t>(4 * (q + 1));
  add("Int32", "connectivity", 1, mesh.quads);
  add("Int32", "offsets", 1, ends);
  add("UInt8", "types", 1, std::vector<std::uint8_t>(mesh.quad_count(), vtk_quad));
  head += "</Cells>\n</Piece>\n</UnstructuredGrid>\n<AppendedData encoding=\"base64\">\n_";
  write_text(path, head + data + "\n</AppendedData>\n</VTKFile>\n");
}

double compute_vtu_size(std::size_t points, std::size_t quads, std::size_t vectors) {
  const auto array = [](std::size_t bytes) {
    return static_cast<double>(base64_size(sizeof(std::uint64_t) + bytes));
  };
  const double text = 855 + 95.0 * static_cast<double>(vectors);
  return text + array(12 * points) * static_cast<double>(1 + vectors) + array(16 * quads) + array(4 * quads) +
         array(quads);
}

void write_pvtu(const std::filesystem::path& path, const std::vector<std::string>& pieces,
                const std::vector<std::string>& vectors) {
  std::string text = fmt::format(
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"PUnstructuredGrid\" version=\"1.0\" byte_order=\"{}\" "
      "header_type=\"UInt64\">\n<PUnstructuredGrid GhostLevel=\"0\">\n<PPointData>\n",
      byte_order());
  const auto array = [](const std::string& name) {
    return fmt::format("<PDataArray type=\"Float32\" Name=\"{}\" NumberOfComponents=\"3\"/>\n", escape(name));
  };
  for (const std::string& name : vectors) text += array(name);
  text += "</PPointData>\n<PPoints>\n" + array("Points") + "</PPoints>\n";
  for (const std::string& piece : pieces) text += fmt::format("<Piece Source=\"{}\"/>\n", escape(piece));
  write_text(path, text + "</PUnstructuredGrid>\n</VTKFile>\n");
}

void write_pvd(const std::filesystem::path& path, const std::vector<PvdEntry>& entries) {
  std::string text = fmt::format(
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\" "
      "byte_order=\"{}\">\n<Collection>\n",
      byte_order());
  for (const PvdEntry& entry : entries) {
    text +=
        fmt::format("<DataSet timestep=\"{}\" part=\"0\" file=\"{}\"/>\n", entry.time, escape(entry.file));
  }
  write_text(path, text + "</Collection>\n</VTKFile>\n");
}

}  // namespace easydyn::results

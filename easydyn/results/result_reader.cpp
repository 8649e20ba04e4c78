#include <fmt/format.h>
#include <fmt/ranges.h>

#include <system_error>
#include <utility>

#include "easydyn/error.hpp"
#include "easydyn/results/hdf5_handle.hpp"
#include "easydyn/results/result_file.hpp"

namespace easydyn::results {
namespace {

using RowMajorMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

std::vector<hsize_t> read_shape(hid_t space) {
  std::vector<hsize_t> shape(static_cast<std::size_t>(std::max(0, H5Sget_simple_extent_ndims(space))));
  H5Sget_simple_extent_dims(space, shape.data(), nullptr);
  return shape;
}

bool is_number(hid_t type) {
  const H5T_class_t kind = H5Tget_class(type);
  return kind == H5T_FLOAT || kind == H5T_INTEGER;
}

std::string without_padding(std::string text, H5T_str_t padding) {
  if (padding == H5T_STR_NULLTERM) {
    text.resize(std::min(text.size(), text.find('\0')));
  } else {
    const std::size_t last = text.find_last_not_of(padding == H5T_STR_SPACEPAD ? ' ' : '\0');
    text.resize(last == std::string::npos ? 0 : last + 1);
  }
  return text;
}

}  // namespace

struct ResultReader::Impl {
  std::filesystem::path path;
  Hdf5Handle file;

  [[noreturn]] void fail(const std::string& name, const std::string& what) const {
    throw InputError(fmt::format("{}: \"{}\" {}", path.string(), name, what));
  }

  // True if every step of the path exists (HDF5 does not check the groups on the way).
  bool has(const std::string& name) const {
    for (std::size_t end = name.find('/', 1);; end = name.find('/', end + 1)) {
      const std::string step = name.substr(0, end);
      if (step.empty() || H5Lexists(file.id(), step.c_str(), H5P_DEFAULT) <= 0) {
        return false;
      }
      if (end == std::string::npos) {
        return true;
      }
    }
  }

  Hdf5Handle open(const std::string& name) const {
    if (!has(name)) {
      fail(name, "is missing");
    }
    Hdf5Handle dataset(H5Dopen2(file.id(), name.c_str(), H5P_DEFAULT), H5Dclose);
    if (!dataset.is_valid()) {
      fail(name, "is not a dataset");
    }
    return dataset;
  }

  // All values of a numeric dataset, row by row, and its shape.
  std::vector<double> read_numbers(const std::string& name, std::vector<hsize_t>& shape) const {
    const Hdf5Handle dataset = open(name);
    const Hdf5Handle type(H5Dget_type(dataset.id()), H5Tclose);
    if (!is_number(type.id())) {
      fail(name, "must hold numbers");
    }
    const Hdf5Handle space(H5Dget_space(dataset.id()), H5Sclose);
    shape = read_shape(space.id());
    const hssize_t size = H5Sget_simple_extent_npoints(space.id());
    std::vector<double> values(static_cast<std::size_t>(std::max<hssize_t>(size, 0)));
    if (!values.empty() &&
        H5Dread(dataset.id(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) < 0) {
      fail(name, "cannot be read, " + last_hdf5_error());
    }
    return values;
  }

  // The strings behind a dataset or an attribute; `read(memory_type, buffer)` fetches them.
  template <typename Read>
  std::vector<std::string> read_strings(const std::string& name, hid_t type, hid_t space, Read read) const {
    if (H5Tget_class(type) != H5T_STRING) {
      fail(name, "must hold text");
    }
    const auto count = static_cast<std::size_t>(std::max<hssize_t>(H5Sget_simple_extent_npoints(space), 0));
    std::vector<std::string> strings(count);
    if (count == 0) {
      return strings;
    }
    if (H5Tis_variable_str(type) > 0) {
      std::vector<char*> pointers(count, nullptr);
      if (read(type, pointers.data()) < 0) {
        fail(name, "cannot be read, " + last_hdf5_error());
      }
      for (std::size_t i = 0; i < count; ++i) {
        strings[i] = pointers[i] ? pointers[i] : "";
      }
      H5Dvlen_reclaim(type, space, H5P_DEFAULT, pointers.data());
    } else {
      const std::size_t length = H5Tget_size(type);
      std::string block(length * count, '\0');
      if (read(type, block.data()) < 0) {
        fail(name, "cannot be read, " + last_hdf5_error());
      }
      for (std::size_t i = 0; i < count; ++i) {
        strings[i] = without_padding(block.substr(i * length, length), H5Tget_strpad(type));
      }
    }
    return strings;
  }

  std::vector<std::string> read_dataset_strings(const std::string& name) const {
    const Hdf5Handle dataset = open(name);
    const Hdf5Handle type(H5Dget_type(dataset.id()), H5Tclose);
    const Hdf5Handle space(H5Dget_space(dataset.id()), H5Sclose);
    return read_strings(name, type.id(), space.id(), [&](hid_t memory_type, void* out) {
      return H5Dread(dataset.id(), memory_type, H5S_ALL, H5S_ALL, H5P_DEFAULT, out);
    });
  }

  Hdf5Handle open_attribute(hid_t object, const std::string& name) const {
    if (H5Aexists(object, name.c_str()) <= 0) {
      fail(name, "is missing (attribute)");
    }
    return Hdf5Handle(H5Aopen(object, name.c_str(), H5P_DEFAULT), H5Aclose);
  }

  std::string read_attribute_text(hid_t object, const std::string& name) const {
    const Hdf5Handle attribute = open_attribute(object, name);
    const Hdf5Handle type(H5Aget_type(attribute.id()), H5Tclose);
    const Hdf5Handle space(H5Aget_space(attribute.id()), H5Sclose);
    const std::vector<std::string> strings =
        read_strings(name, type.id(), space.id(),
                     [&](hid_t memory_type, void* out) { return H5Aread(attribute.id(), memory_type, out); });
    return strings.empty() ? "" : strings.front();
  }
};

ResultReader::ResultReader(std::filesystem::path path) : impl_(std::make_unique<Impl>()) {
  const Hdf5Silence silence;
  impl_->path = std::move(path);
  std::error_code ignored;
  if (!std::filesystem::exists(impl_->path, ignored)) {
    throw InputError(fmt::format("{}: no such file", impl_->path.string()));
  }
  impl_->file = Hdf5Handle(H5Fopen(impl_->path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  if (!impl_->file.is_valid()) {
    throw InputError(
        fmt::format("{}: is not a readable HDF5 file, {}", impl_->path.string(), last_hdf5_error()));
  }
}

ResultReader::~ResultReader() = default;

bool ResultReader::has(const std::string& name) const {
  const Hdf5Silence silence;
  return impl_->has(name);
}

Eigen::VectorXd ResultReader::read_vector(const std::string& name) const {
  const Hdf5Silence silence;
  std::vector<hsize_t> shape;
  const std::vector<double> values = impl_->read_numbers(name, shape);
  const bool is_flat_matrix = shape.size() == 2 && (shape[0] == 1 || shape[1] == 1);
  if (shape.size() != 1 && !is_flat_matrix) {
    impl_->fail(name, fmt::format("has the shape ({}), must be a vector", fmt::join(shape, " x ")));
  }
  return Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

Eigen::MatrixXd ResultReader::read_matrix(const std::string& name) const {
  const Hdf5Silence silence;
  std::vector<hsize_t> shape;
  const std::vector<double> values = impl_->read_numbers(name, shape);
  if (shape.size() != 2) {
    impl_->fail(name, fmt::format("has the shape ({}), must be a matrix", fmt::join(shape, " x ")));
  }
  return Eigen::Map<const RowMajorMatrix>(values.data(), static_cast<Eigen::Index>(shape[0]),
                                          static_cast<Eigen::Index>(shape[1]));
}

std::string ResultReader::read_text(const std::string& name) const {
  const Hdf5Silence silence;
  const std::vector<std::string> strings = impl_->read_dataset_strings(name);
  if (strings.size() != 1) {
    impl_->fail(name, fmt::format("holds {} texts, must hold one", strings.size()));
  }
  return strings.front();
}

std::vector<std::string> ResultReader::read_names(const std::string& name) const {
  const Hdf5Silence silence;
  return impl_->read_dataset_strings(name);
}

Meaning ResultReader::read_meaning(const std::string& name) const {
  const Hdf5Silence silence;
  const Hdf5Handle dataset = impl_->open(name);
  const auto read = [&](const char* attribute) {
    return H5Aexists(dataset.id(), attribute) > 0 ? impl_->read_attribute_text(dataset.id(), attribute)
                                                  : std::string();
  };
  return {.units = read("units"), .description = read("description"), .frame = read("frame")};
}

double ResultReader::read_number_attribute(const std::string& name) const {
  const Hdf5Silence silence;
  const Hdf5Handle attribute = impl_->open_attribute(impl_->file.id(), name);
  const Hdf5Handle type(H5Aget_type(attribute.id()), H5Tclose);
  const Hdf5Handle space(H5Aget_space(attribute.id()), H5Sclose);
  double value = 0;
  if (!is_number(type.id()) || H5Sget_simple_extent_npoints(space.id()) != 1 ||
      H5Aread(attribute.id(), H5T_NATIVE_DOUBLE, &value) < 0) {
    impl_->fail(name, "must be one number (attribute)");
  }
  return value;
}

std::string ResultReader::read_text_attribute(const std::string& name) const {
  const Hdf5Silence silence;
  return impl_->read_attribute_text(impl_->file.id(), name);
}

const std::filesystem::path& ResultReader::path() const {
  return impl_->path;
}

}  // namespace easydyn::results

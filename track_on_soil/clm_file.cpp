#include "track_on_soil/clm_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>

#include "easydyn/error.hpp"
#include "soil/mobility_file.hpp"
#include "soil/mobility_identity.hpp"
#include "soil/toml_table.hpp"

namespace easydyn::track_on_soil {
namespace {

namespace fs = std::filesystem;
using soil::TomlTable;

constexpr int format = 2, oldest_format = 1;

std::string list_of(const Eigen::VectorXd& values) {
  return fmt::format("[{}]", fmt::join(values.begin(), values.end(), ", "));
}

// Within quotation marks.
std::string quote(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') quoted += '\\';
    quoted += c == '\n' ? ' ' : c;
  }
  return quoted + "\"";
}

Eigen::VectorXd read_vector(const TomlTable& table, const char* key, const char* unit) {
  const std::vector<double> values = table.numbers(key, unit);
  return Eigen::VectorXd::Map(values.data(), static_cast<Eigen::Index>(values.size()));
}

Eigen::VectorXcd read_complex(const TomlTable& table, const std::string& key, Eigen::Index size) {
  const Eigen::VectorXd re = read_vector(table, (key + "_re").c_str(), "m/N"),
                        im = read_vector(table, (key + "_im").c_str(), "m/N");
  if (re.size() != size || im.size() != size)
    table.fail(key + "_re",
               fmt::format("{} and {} values, must be {}, one per frequency", re.size(), im.size(), size));
  Eigen::VectorXcd values(size);
  values.real() = re;
  values.imag() = im;
  return values;
}

bool is_same_material(const soil::Layer& a, const soil::Layer& b) {
  return a.density == b.density && a.cs == b.cs && a.cp == b.cp && a.damping == b.damping;
}

bool is_same_block(const soil::Block& a, const soil::Block& b) {
  return a.x == b.x && a.y == b.y && a.z == b.z && a.open == b.open && a.mirrored == b.mirrored &&
         (a.open || is_same_material(a.material, b.material));
}

std::string describe(const soil::Layer& material) {
  return fmt::format("density = {}\ncs = {}\ncp = {}\ndamping = {}\n", material.density, material.cs,
                     material.cp, material.damping);
}

void read_material(const TomlTable& table, soil::Layer& material) {
  material.density = table.number("density", "kg/m3", soil::positive);
  material.cs = table.number("cs", "m/s", soil::positive);
  material.cp = table.number("cp", "m/s", soil::positive);
  material.damping = table.number("damping", "", soil::not_negative);
}

soil::Block read_block(const TomlTable& table) {
  table.refuse_other_keys({"x", "y", "z", "open", "mirrored", "density", "cs", "cp", "damping"});
  soil::Block block;
  block.x = table.interval("x", "m", true);
  block.y = table.interval("y", "m", true);
  block.z = table.interval("z", "m", false);
  block.open = table.flag("open", false);
  block.mirrored = table.flag("mirrored", false);
  if (!block.open) read_material(table, block.material);
  return block;
}

std::vector<std::string> split(const std::string& text) {
  std::vector<std::string> parts;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find("; ", begin), text.size());
    parts.push_back(text.substr(begin, end - begin));
    begin = end + 2;
  }
  return parts;
}

}  // namespace

bool has_constant_ratio(soil::GroundDamping damping) {
  return damping == soil::GroundDamping::maxwell_body || damping == soil::GroundDamping::constant_q;
}

bool SiteClm::knows_blocks() const {
  return method == soil::element_method;
}

std::string SiteClm::find_mismatch(const soil::Site& site, const FootprintRow& footprints) const {
  if (revision != fit_revision)
    return fmt::format("is of revision {} of the fit, not {}", revision, fit_revision);
  if (method != soil::layered_method && method != soil::element_method && method != mixed_method)
    return fmt::format("is of an unknown method \"{}\"", method);
  if (!has_constant_ratio(damping)) return fmt::format("has the damping \"{}\"", soil::name_of(damping));
  if (!(row == footprints)) return "belongs to other footprints";
  if (damping_frequency != site.damping_frequency) return "belongs to another damping frequency";
  bool are_same = layers.size() == site.layers.size();
  for (std::size_t i = 0; are_same && i < layers.size(); ++i) {
    const soil::Layer &a = layers[i], &b = site.layers[i];
    are_same = (i + 1 == layers.size() || a.thickness == b.thickness) && is_same_material(a, b);
  }
  if (!are_same) return "belongs to other layers";
  return std::ranges::equal(blocks, site.blocks, is_same_block) ? "" : "belongs to other blocks";
}

fs::path clm_file_of(const fs::path& site) {
  return fs::path(site).replace_extension(".clm.toml");
}

void write_clm(const fs::path& path, const SiteClm& clm) {
  const track::Clm& c = clm.fit.clm;
  std::string text = fmt::format(
      R"(# Coupled lumped mass foundation of a track on a site: made by `calibrate` or by the program of a train.
# It is used again as long as the ground and footprints of a run are those below. Delete it to have it made anew.
format = {}
source = {}

[clm]  # per sleeper, both rails
m_f = {}  # kg
k_f = {}  # N/m
d_f = {}  # N s/m
k_c = {}  # N/m
d_c = {}  # N s/m

[footprint]
length = {}  # m, along the track
width = {}  # m
spacing = {}  # m

[ground]
method = {}  # of its compliance
damping = {}
damping_frequency = {}  # Hz
)",
      format, quote(c.k_f.source), c.m_f.value, c.k_f.value, c.d_f.value, c.k_c.value, c.d_c.value,
      clm.row.length, clm.row.width, clm.row.spacing, quote(clm.method), quote(soil::name_of(clm.damping)),
      clm.damping_frequency);
  for (const soil::Layer& layer : clm.layers) {
    text += "\n[[ground.layer]]\n";
    if (&layer != &clm.layers.back()) text += fmt::format("thickness = {}\n", layer.thickness);
    text += describe(layer);
  }
  for (const soil::Block& block : clm.blocks) {
    text += fmt::format(
        "\n[[ground.block]]\nx = [{}, {}]\ny = [{}, {}]\nz = [{}, {}]\nopen = {}\nmirrored = {}\n",
        block.x[0], block.x[1], block.y[0], block.y[1], block.z[0], block.z[1], block.open, block.mirrored);
    if (!block.open) text += describe(block.material);
  }
  const track::ClmFit& fit = clm.fit;
  text += fmt::format(
      R"(
[fit]
revision = {}
lowest = {}  # Hz
highest = {}  # Hz
foundations = {}  # of the chain; 0: infinitely many
system = {}
rms_00 = {}  # error of H_00 over |H_00| at the lowest frequency
rms_01 = {}
stiffness_margin = {}  # (k_f + 4 k_c) / k_f, passive: >= 0
damping_margin = {}  # (d_f + 4 d_c) / d_f, passive: >= 0
bounds = {}  # on which the fit lies
left_out = {}

[compliance]  # m/N, time factor exp(i w t)
frequency = {}
)",
      clm.revision, clm.lowest, clm.highest, clm.foundations, quote(fit.system), fit.rms_00, fit.rms_01,
      fit.stiffness_margin, fit.damping_margin, quote(fmt::format("{}", fmt::join(fit.bounds, "; "))),
      fit.left_out, list_of(fit.frequency));
  const std::pair<const char*, const Eigen::VectorXcd*> responses[] = {{"ground_00", &fit.ground_00},
                                                                       {"ground_01", &fit.ground_01},
                                                                       {"model_00", &fit.model_00},
                                                                       {"model_01", &fit.model_01}};
  for (const auto& [name, values] : responses)
    text +=
        fmt::format("{0}_re = {1}\n{0}_im = {2}\n", name, list_of(values->real()), list_of(values->imag()));

  const fs::path temporary = fs::path(path).concat(".part");
  std::ofstream file(temporary, std::ios::binary);
  file << text;
  file.close();
  std::error_code error;
  if (file) fs::rename(temporary, path, error);
  if (!file || error) {
    std::error_code ignored;
    fs::remove(temporary, ignored);
    throw InputError(fmt::format("{}: cannot be written", path.string()));
  }
}

SiteClm read_clm(const fs::path& path) {
  toml::table parsed;
  try {
    parsed = toml::parse_file(path.string());
  } catch (const toml::parse_error& error) {
    throw InputError(fmt::format("{}:{}:{}: {}", path.string(), error.source().begin.line,
                                 error.source().begin.column, error.description()));
  }
  const TomlTable root(path, "", parsed);
  root.refuse_other_keys({"format", "source", "clm", "footprint", "ground", "fit", "compliance"});
  const double version = root.number("format", "", {.low = oldest_format, .high = format});
  SiteClm result;
  track::ClmFit& fit = result.fit;

  const TomlTable clm = root.table("clm");
  clm.refuse_other_keys({"m_f", "k_f", "d_f", "k_c", "d_c"});
  const std::string source = root.text("source");
  const auto constant = [&](const char* key, const char* unit) {
    return Sourced(clm.number(key, unit, soil::any_number), source);
  };
  fit.clm = {constant("m_f", "kg"), constant("k_f", "N/m"), constant("d_f", "N s/m"), constant("k_c", "N/m"),
             constant("d_c", "N s/m")};
  validate(track::Foundation(fit.clm), path.string());

  const TomlTable footprint = root.table("footprint");
  footprint.refuse_other_keys({"length", "width", "spacing"});
  result.row = {footprint.number("length", "m", soil::positive),
                footprint.number("width", "m", soil::positive),
                footprint.number("spacing", "m", soil::positive)};

  const TomlTable ground = root.table("ground");
  ground.refuse_other_keys({"damping_frequency", "method", "damping", "layer", "block"});
  if (version > oldest_format) {
    result.method = ground.text("method");
    try {
      result.damping = soil::find_ground_damping(ground.text("damping"));
    } catch (const InputError& error) {
      ground.fail("damping", error.what());
    }
    for (const TomlTable& table : ground.tables("block")) result.blocks.push_back(read_block(table));
  }
  result.damping_frequency = ground.number("damping_frequency", "Hz", soil::positive);
  const std::vector<TomlTable> layers = ground.tables("layer");
  for (const TomlTable& table : layers) {
    table.refuse_other_keys({"thickness", "density", "cs", "cp", "damping"});
    soil::Layer layer;
    layer.thickness = &table == &layers.back() ? std::numeric_limits<double>::infinity()
                                               : table.number("thickness", "m", soil::positive);
    read_material(table, layer);
    result.layers.push_back(layer);
  }

  const TomlTable fitted = root.table("fit");
  fitted.refuse_other_keys({"revision", "lowest", "highest", "foundations", "system", "rms_00", "rms_01",
                            "stiffness_margin", "damping_margin", "bounds", "left_out"});
  result.revision =
      version > oldest_format ? static_cast<int>(fitted.number("revision", "", {.low = 0, .high = 1e6})) : 0;
  result.lowest = fitted.number("lowest", "Hz", soil::positive);
  result.highest = fitted.number("highest", "Hz", soil::positive);
  result.foundations = static_cast<int>(fitted.number("foundations", "", {.low = 0, .high = 1e6}));
  fit.system = fitted.text("system");
  fit.rms_00 = fitted.number("rms_00", "", soil::not_negative);
  fit.rms_01 = fitted.number("rms_01", "", soil::not_negative);
  fit.stiffness_margin = fitted.number("stiffness_margin", "", soil::not_negative);
  fit.damping_margin = fitted.number("damping_margin", "", soil::not_negative);
  fit.bounds = split(fitted.text("bounds", ""));
  fit.left_out = fitted.number("left_out", "", soil::not_negative);

  const TomlTable compliance = root.table("compliance");
  compliance.refuse_other_keys({"frequency", "ground_00_re", "ground_00_im", "ground_01_re", "ground_01_im",
                                "model_00_re", "model_00_im", "model_01_re", "model_01_im"});
  fit.frequency = read_vector(compliance, "frequency", "Hz");
  const Eigen::Index n = fit.frequency.size();
  fit.ground_00 = read_complex(compliance, "ground_00", n);
  fit.ground_01 = read_complex(compliance, "ground_01", n);
  fit.model_00 = read_complex(compliance, "model_00", n);
  fit.model_01 = read_complex(compliance, "model_01", n);
  return result;
}

}  // namespace easydyn::track_on_soil

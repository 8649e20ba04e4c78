#include "easydyn/results/result_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include "easydyn/error.hpp"
#include "easydyn/results/hdf5_handle.hpp"
#include "easydyn/results/pending_file.hpp"

namespace easydyn::results {
namespace {

using RowMajorMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

// A UTF-8 string type of `length` bytes, padded with zeros.
Hdf5Handle make_string_type(std::size_t length) {
  Hdf5Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type.id(), std::max<std::size_t>(length, 1));
  H5Tset_strpad(type.id(), H5T_STR_NULLPAD);
  H5Tset_cset(type.id(), H5T_CSET_UTF8);
  return type;
}

bool is_refused(double value, bool allow_nan) {
  return !(std::isfinite(value) || (allow_nan && std::isnan(value)));
}

}  // namespace

struct ResultFile::Impl {
  explicit Impl(std::filesystem::path path) : pending(std::move(path)) {}

  PendingFile pending;
  Hdf5Handle file;

  [[noreturn]] void fail(const std::string& name) const {
    throw InputError(
        fmt::format("{}: \"{}\" cannot be written, {}", pending.path().string(), name, last_hdf5_error()));
  }

  // Attribute `name` of an object: one number or one text.
  void attach(hid_t object, const std::string& name, hid_t type, const void* value) const {
    const Hdf5Handle space(H5Screate(H5S_SCALAR), H5Sclose);
    const Hdf5Handle attribute(H5Acreate2(object, name.c_str(), type, space.id(), H5P_DEFAULT, H5P_DEFAULT),
                               H5Aclose);
    if (!attribute.is_valid() || H5Awrite(attribute.id(), type, value) < 0) {
      fail(name);
    }
  }
  void attach(hid_t object, const std::string& name, const std::string& text) const {
    attach(object, name, make_string_type(text.size()).id(), text.c_str());
  }

  // A dataset of the given shape (no dimension: a scalar) with its values.
  Hdf5Handle create(const std::string& name, hid_t type, const std::vector<hsize_t>& shape,
                    const void* values) const {
    const Hdf5Handle space(shape.empty()
                               ? H5Screate(H5S_SCALAR)
                               : H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr),
                           H5Sclose);
    const Hdf5Handle make_groups(H5Pcreate(H5P_LINK_CREATE), H5Pclose);
    H5Pset_create_intermediate_group(make_groups.id(), 1);
    Hdf5Handle dataset(
        H5Dcreate2(file.id(), name.c_str(), type, space.id(), make_groups.id(), H5P_DEFAULT, H5P_DEFAULT),
        H5Dclose);
    const double nothing = 0;  // HDF5 wants an address even where there is nothing to write
    if (!dataset.is_valid() ||
        H5Dwrite(dataset.id(), type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values ? values : &nothing) < 0) {
      fail(name);
    }
    return dataset;
  }

  void write_numbers(const std::string& name, const std::vector<hsize_t>& shape, const double* values,
                     const Meaning& meaning) const {
    const Hdf5Handle dataset = create(name, H5T_NATIVE_DOUBLE, shape, values);
    attach(dataset.id(), "units", meaning.units);
    attach(dataset.id(), "description", meaning.description);
    attach(dataset.id(), "frame", meaning.frame);
  }
};

ResultFile::ResultFile(std::filesystem::path path, const Provenance& provenance)
    : impl_(std::make_unique<Impl>(std::move(path))) {
  const Hdf5Silence silence;
  impl_->file = Hdf5Handle(
      H5Fcreate(impl_->pending.partial_path().c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), H5Fclose);
  if (!impl_->file.is_valid()) {
    throw InputError(
        fmt::format("{}: cannot be written, {}", impl_->pending.path().string(), last_hdf5_error()));
  }
  write_attribute("program", provenance.program);
  write_attribute("version", provenance.version.empty() ? library_version() : provenance.version);
  write_attribute("command", provenance.command);
  write_attribute("created", provenance.created.empty() ? current_time_utc() : provenance.created);
  write_attribute("convention", provenance.convention);
}

ResultFile::~ResultFile() = default;

void ResultFile::write_vector(const std::string& name, const Eigen::Ref<const Eigen::VectorXd>& values,
                              const Meaning& meaning, bool allow_nan) {
  const Hdf5Silence silence;
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    if (is_refused(values(i), allow_nan)) {
      throw ModelError(fmt::format("dataset \"{}\": value ({}) is {}, must be finite", name, i, values(i)));
    }
  }
  impl_->write_numbers(name, {static_cast<hsize_t>(values.size())}, values.data(), meaning);
}

void ResultFile::write_matrix(const std::string& name, const Eigen::Ref<const Eigen::MatrixXd>& values,
                              const Meaning& meaning, bool allow_nan) {
  const Hdf5Silence silence;
  for (Eigen::Index j = 0; j < values.cols(); ++j) {
    for (Eigen::Index i = 0; i < values.rows(); ++i) {
      if (is_refused(values(i, j), allow_nan)) {
        throw ModelError(
            fmt::format("dataset \"{}\": value ({}, {}) is {}, must be finite", name, i, j, values(i, j)));
      }
    }
  }
  const RowMajorMatrix rows = values;
  impl_->write_numbers(name, {static_cast<hsize_t>(rows.rows()), static_cast<hsize_t>(rows.cols())},
                       rows.data(), meaning);
}

void ResultFile::write_text(const std::string& name, const std::string& text,
                            const std::string& description) {
  const Hdf5Silence silence;
  const Hdf5Handle dataset = impl_->create(name, make_string_type(text.size()).id(), {}, text.c_str());
  impl_->attach(dataset.id(), "description", description);
}

void ResultFile::write_names(const std::string& name, const std::vector<std::string>& names,
                             const std::string& description) {
  const Hdf5Silence silence;
  // All names in one block, each in a field as long as the longest name.
  std::size_t length = 1;
  for (const std::string& entry : names) {
    length = std::max(length, entry.size());
  }
  std::vector<char> block(length * names.size(), '\0');
  for (std::size_t i = 0; i < names.size(); ++i) {
    std::memcpy(block.data() + i * length, names[i].data(), names[i].size());
  }
  const Hdf5Handle dataset = impl_->create(name, make_string_type(length).id(), {names.size()},
                                           block.empty() ? nullptr : block.data());
  impl_->attach(dataset.id(), "description", description);
}

void ResultFile::write_attribute(const std::string& name, double value) {
  const Hdf5Silence silence;
  if (!std::isfinite(value)) {
    throw ModelError(fmt::format("attribute \"{}\" is {}, must be finite", name, value));
  }
  impl_->attach(impl_->file.id(), name, H5T_NATIVE_DOUBLE, &value);
}

void ResultFile::write_attribute(const std::string& name, const std::string& value) {
  const Hdf5Silence silence;
  impl_->attach(impl_->file.id(), name, value);
}

void ResultFile::commit() {
  const Hdf5Silence silence;
  if (H5Fflush(impl_->file.id(), H5F_SCOPE_LOCAL) < 0 || !impl_->file.close()) {
    throw InputError(
        fmt::format("{}: cannot be completed, {}", impl_->pending.path().string(), last_hdf5_error()));
  }
  impl_->pending.commit();
}

}  // namespace easydyn::results

#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "easydyn/results/provenance.hpp"

namespace easydyn::results {

/// What a numeric dataset is.
struct Meaning {
  std::string units;        ///< SI, "1" where dimensionless
  std::string description;  ///< one sentence
  std::string frame;        ///< axes and sign, e.g. "z up", "downward"
};

/// An HDF5 file in the making. It lives under a temporary name beside `path` and takes its name in commit();
/// destroyed before that (an exception, a killed run), it leaves nothing under `path`.
/// Names are paths ("/rail/deflection"); groups are made as needed. Non-finite numbers are refused; where
/// `allow_nan` is said for a dataset, NaN stands for a value that is not known (never an infinity).
/// Numbers are stored as 64-bit floats, texts as fixed-length UTF-8 strings (which Octave reads, too).
/// @throws InputError if the file cannot be written, ModelError on a non-finite value (dataset and index
/// named)
class ResultFile {
 public:
  ResultFile(std::filesystem::path path, const Provenance& provenance);
  ~ResultFile();
  ResultFile(const ResultFile&) = delete;
  ResultFile& operator=(const ResultFile&) = delete;

  void write_vector(const std::string& name, const Eigen::Ref<const Eigen::VectorXd>& values,
                    const Meaning& meaning, bool allow_nan = false);
  /// Rows become the first index of the dataset.
  void write_matrix(const std::string& name, const Eigen::Ref<const Eigen::MatrixXd>& values,
                    const Meaning& meaning, bool allow_nan = false);
  void write_text(const std::string& name, const std::string& text, const std::string& description);
  void write_names(const std::string& name, const std::vector<std::string>& names,
                   const std::string& description);
  void write_attribute(const std::string& name, double value);  ///< of the root
  void write_attribute(const std::string& name, const std::string& value);

  /// Closes the file and gives it its name.
  void commit();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// An HDF5 file to read. Numbers of any type and strings of fixed or variable length are understood; a vector
/// may also be stored as n x 1 or 1 x n (as MATLAB and Octave do).
/// @throws InputError naming file, dataset and what was expected
class ResultReader {
 public:
  explicit ResultReader(std::filesystem::path path);
  ~ResultReader();
  ResultReader(const ResultReader&) = delete;
  ResultReader& operator=(const ResultReader&) = delete;

  bool has(const std::string& name) const;
  Eigen::VectorXd read_vector(const std::string& name) const;
  Eigen::MatrixXd read_matrix(const std::string& name) const;
  std::string read_text(const std::string& name) const;
  std::vector<std::string> read_names(const std::string& name) const;
  Meaning read_meaning(const std::string& name) const;
  double read_number_attribute(const std::string& name) const;
  std::string read_text_attribute(const std::string& name) const;
  const std::filesystem::path& path() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace easydyn::results

#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "easydyn/parameter.hpp"
#include "easydyn/results/provenance.hpp"
#include "track/passage.hpp"
#include "track/track_data.hpp"

namespace easydyn::track {

/// A figure that a run wants to show in its report.
struct SummaryFigure {
  std::string name;
  double value = 0;
  std::string unit;
};

/// Writes `results.h5` of a passage: every channel, parameters with provenance, summary, scene;
/// docs/formats.md.
/// @param description  what was run, one sentence
/// @param scene        JSON of the animated scene (easydyn/visu/scene.hpp), may be empty
/// @throws InputError if the file cannot be written, ModelError on a value that is not finite
void write_passage(const std::filesystem::path& path, const Passage& passage, const std::string& description,
                   const std::vector<Parameter>& parameters, const std::vector<SummaryFigure>& summary,
                   const std::string& scene, const results::Provenance& provenance);

/// Writes `channels.csv`: contact forces, rail, sleeper and foundation displacement and ballast reaction at
/// the recorded sleeper nearest to x, and the vertical acceleration of every body.
void write_passage_channels(const std::filesystem::path& path, const Passage& passage, double x);

}  // namespace easydyn::track

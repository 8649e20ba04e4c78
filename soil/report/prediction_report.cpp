#include "soil/report/prediction_report.hpp"

#include <fmt/format.h>

#include <optional>

#include "easydyn/error.hpp"
#include "easydyn/visu/json.hpp"
#include "easydyn/visu/parameter_json.hpp"
#include "soil/report/sections.hpp"
#include "soil/report/text.hpp"

namespace easydyn::soil {

namespace {

namespace json = visu::json;
using results::ResultReader;

std::string text_of(const json::Value& value) {
  if (value.is_null()) return "\u2013";
  try {
    return value.string();
  } catch (const Error&) {
    return visu::short_number_text(value.number(), 4);
  }
}

std::string member(const json::Value& object, const char* name) {
  return object.has(name) ? text_of(object.at(name)) : "";
}

/// Calls `use` with every object of a JSON array stored as text.
template <typename Use>
void for_each_object(const ResultReader& file, const std::string& dataset, Use use) {
  if (!file.has(dataset)) return;
  const std::string source = fmt::format("{}:{}", file.path().string(), dataset);
  const json::Value value = json::parse(file.read_text(dataset), source);
  try {
    for (const json::Value& object : value.array()) use(object);
  } catch (const Error& error) {
    throw InputError(fmt::format("{}: {}", source, error.what()));
  }
}

using Facts = std::vector<std::pair<std::string, std::string>>;

Facts origin(const std::string& step, const ResultReader& file) {
  const auto text = [&](const char* name) { return file.read_text_attribute(name); };
  return {{step, fmt::format("{} {}, {}, in `{}`", text("program"), text("version"), text("created"),
                             file.path().filename().string())},
          {"Command", fmt::format("`{}`", text("command"))},
          {"Convention", text("convention")}};
}

std::vector<visu::KeyFigure> key_figures(const ResultReader* track, const ResultReader* ground,
                                         const std::optional<report::Comparison>& comparison) {
  std::vector<visu::KeyFigure> figures;  // what was asked first
  if (ground) figures = report::ground_key_figures(*ground);
  if (comparison) figures.push_back(report::recoupling_key_figure(*comparison));
  if (track)
    for_each_object(*track, "/summary", [&](const json::Value& v) {
      figures.push_back({member(v, "name"), member(v, "value"), member(v, "unit"), member(v, "remark")});
    });
  return figures;
}

void add_animation(visu::Report& report, const ResultReader& track) {
  if (!track.has("/scene")) return;
  visu::Scene scene = visu::scene_from_json(track.read_text("/scene"), track.path().string() + ":/scene");
  report.add_section("The passage");
  report.add_animation(std::move(scene),
                       "Deflections are magnified by the factor shown in the picture; lengths are true.");
}

void add_parameters(visu::Report& report, const char* title, const ResultReader& file) {
  if (!file.has("/parameters")) return;
  std::vector<Parameter> parameters =
      visu::parameters_from_json(file.read_text("/parameters"), file.path().string() + ":/parameters");
  if (parameters.empty()) return;
  report.add_subsection(title);
  report.add_parameters(std::move(parameters));
}

/// The material damping by the row of the parameters that names the model.
std::string damping_text(const ResultReader& ground) {
  std::optional<double> model, frequency;
  for_each_object(ground, "/parameters", [&](const json::Value& v) {
    const std::string& name = v.at("name").string();
    if (name.starts_with("material damping")) model = v.at("value").number();
    if (name.starts_with("frequency of the damping ratios")) frequency = v.at("value").number();
  });
  const std::string at = frequency ? visu::short_number_text(*frequency) + " Hz" : "the frequency given";
  if (!model) return "the file does not say how material damping was modelled";
  if (*model == 0) return "there is no material damping";
  if (*model == 1)
    return fmt::format(
        "material damping grows in proportion to frequency from the ratios of the site file at {}", at);
  if (*model == 3)
    return fmt::format(
        "material damping keeps the ratios of the site file at all frequencies; wave speeds hold at {}", at);
  return fmt::format(
      "material damping nearly keeps the ratios of the site file, from a fortieth of the highest frequency "
      "to "
      "it; "
      "ratios and wave speeds hold at {}",
      at);
}

void add_limits(visu::Report& report, const ResultReader* track, const ResultReader* ground,
                bool has_comparison) {
  report.add_section("Limits and assumptions");
  std::vector<std::string> limits;
  if (track) {
    limits.push_back(
        "Vehicle and track move in the vertical plane; one wheelset stands for both of its contacts, and all "
        "track "
        "quantities are those of both rails together.");
    limits.push_back(
        "Ballast and foundation are linear; gravity acts on the vehicle alone, since the dead load of the "
        "track was "
        "in the ground before. Uplift can therefore make a reaction slightly negative.");
    limits.push_back(
        std::string("The foundation of step 1 has parameters that do not depend on frequency. It follows the "
                    "soil up to a frequency that depends on the site") +
        (has_comparison ? "; the recoupling error says how well in this run." : "."));
  }
  if (ground) {
    limits.push_back(
        fmt::format("Nothing is claimed above {} Hz: the mesh of the soil does not resolve it. {}",
                    visu::short_number_text(ground->read_number_attribute("highest_frequency")),
                    report::band_text(ground->read_number_attribute("highest_frequency"))));
    limits.push_back(
        "The ground consists of horizontal, homogeneous, linear, isotropic layers; " + damping_text(*ground) +
        ". Loads fade out towards both ends of the loaded track, so receivers beyond them see too "
        "little.");
    limits.push_back("The result is the free field: no building, no foundation of a building, no floors.");
    limits.push_back(
        "Predictions of absolute levels are no better than about 10 dB; differences between variants "
        "computed with "
        "the same model are more reliable.");
  }
  limits.push_back(
      "A parameter whose source says that it is recalled, assumed or representative has not been measured on "
      "the "
      "object that carries its name.");
  report.add_list(std::move(limits));
}

}  // namespace

void write_prediction_report(const std::filesystem::path& results_dir, const std::filesystem::path& html) {
  const auto track_path = results_dir / "results.h5", ground_path = results_dir / "vibrations.h5";
  std::optional<ResultReader> track_file, ground_file;
  if (std::filesystem::exists(track_path)) track_file.emplace(track_path);
  if (std::filesystem::exists(ground_path)) ground_file.emplace(ground_path);
  if (!track_file && !ground_file)
    throw InputError(fmt::format("{}: holds neither results.h5 nor vibrations.h5", results_dir.string()));
  const ResultReader *track = track_file ? &*track_file : nullptr,
                     *ground = ground_file ? &*ground_file : nullptr;

  std::optional<report::Comparison> comparison;
  std::string no_comparison;
  try {
    if (track && ground) comparison = report::compare_displacements(*track, *ground);
  } catch (const ModelError& error) {
    no_comparison = error.what();
  }

  visu::Report report(
      !ground  ? "Passage over the track"
      : !track ? "Ground vibration: prediction"
               : "Railway ground vibration: prediction",
      "Results in " + std::filesystem::absolute(results_dir / "x").parent_path().filename().string());
  Facts facts;
  if (track) facts = origin("Step 1, vehicle and track", *track);
  if (track && track->has("/description"))
    facts.insert(facts.begin(), {"Run", track->read_text("/description")});
  if (ground)
    for (auto& fact : origin("Step 2, ground", *ground)) facts.push_back(std::move(fact));
  if (ground && ground->has("/method")) facts.push_back({"Method", ground->read_text("/method")});
  report.add_facts(std::move(facts));

  report.add_section("Key figures");
  const auto figures = key_figures(track, ground, comparison);
  if (!figures.empty()) report.add_key_figures(figures);
  if (track && track->has("/warnings"))
    for (const std::string& warning : track->read_names("/warnings"))
      report.add_note("Warning: " + warning + ".");
  if (ground)
    report.add_note(
        fmt::format("Free-field prediction, band-limited to {} Hz with a roll-off above it. Absolute levels "
                    "are no better than about 10 dB.",
                    visu::short_number_text(ground->read_number_attribute("highest_frequency"))));
  if (track && ground && ground->read_text_attribute("created") < track->read_text_attribute("created"))
    report.add_note("The ground was computed before this passage: run `soil predict` or `soil run` again.");
  if (track) {
    add_animation(report, *track);
    report::add_track_section(report, *track);
  }
  if (ground) report::add_ground_section(report, *ground, track);
  if (ground) report::add_verification_section(report, *ground);
  if (comparison) report::add_recoupling_section(report, *comparison);
  if (!no_comparison.empty()) report.add_paragraph("Both steps are not compared: " + no_comparison + ".");
  if (track && !comparison && track->has("/foundation/fit/frequency"))
    report.add_section("The foundation of step 1");
  if (track) report::add_foundation(report, *track);

  report.add_section("Parameters and their sources");
  if (track) add_parameters(report, "Vehicle, track and passage", *track);
  if (ground) add_parameters(report, "Ground", *ground);
  if (ground && ground->has("/site")) report.add_text("Site file, as read", ground->read_text("/site"));
  add_limits(report, track, ground, comparison.has_value());
  report.write(html);
}

}  // namespace easydyn::soil

// The foundation of a track from its site: five constants that follow the ground below the sleepers.
//
//   |      |      |      |                         sleepers, as footprints on the ground
//  H_00 = u_0 / F_0,  H_01 = u_1 / F_0             compliances of the layers of the site
//     \_____ calibrate_clm ____ m_f, k_f, d_f, k_c, d_c
//   (m_f)~(m_f)~(m_f)~(m_f)~ ...                   coupled lumped mass (CLM) foundation
//
// Shows: the compliance of layered ground, or of impulse responses (`soil mobility`), condensed by constrained least
// squares. Writes SITE.clm.toml, which the programs of trains take with --site SITE.toml, and a page with both.
//   ./run calibrate examples/sites/tram.toml --footprint 0.285 2.5 --spacing 0.72
// Reference: G. Kouroussis, G. Gazetas, I. Anastasopoulos, C. Conti, O. Verlinden, Discrete modelling of vertical
// track-soil coupling for vehicle-track dynamics, Soil Dyn. Earthq. Eng. 31(12), 2011.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <iostream>
#include <optional>

#include "easydyn/error.hpp"
#include "easydyn/visu/number_text.hpp"
#include "easydyn/visu/report.hpp"
#include "soil/report/compliance_charts.hpp"
#include "soil/site_file.hpp"
#include "track_on_soil/site_foundation.hpp"

using namespace easydyn;
namespace fs = std::filesystem;
using visu::number_text;

namespace {

struct Arguments {
  fs::path site, mobility, clm, output = "results/calibrate";
  std::vector<double> footprint, band = {2, 50};
  double spacing = 0;
  std::string foundations = "infinite";
};

int read_foundations(const std::string& text) {
  if (text == "infinite") return 0;
  std::size_t used = 0;
  int count = 0;
  try {
    count = std::stoi(text, &used);
  } catch (const std::exception&) {
    used = 0;
  }
  if (used != text.size() || count < 2 || count > 500)
    throw InputError(fmt::format("--foundations = {}, must be infinite or a number from 2 to 500", text));
  return count;
}

track_on_soil::SiteClm calibrate(const Arguments& arguments) {
  const track::ClmFitOptions options{.lowest = arguments.band[0],
                                     .highest = arguments.band[1],
                                     .foundations = read_foundations(arguments.foundations)};
  const soil::Site site = soil::read_site(arguments.site);
  for (const std::string& warning : soil::unusual_values(site))
    fmt::print(stderr, "calibrate: warning: {}\n", warning);
  if (arguments.mobility.empty()) {
    if (arguments.footprint.empty() || arguments.spacing == 0)
      throw InputError("no footprints: give --footprint LENGTH WIDTH and --spacing, or --mobility FILE");
    if (!site.blocks.empty())
      fmt::print(stderr, "calibrate: warning: {}: its blocks of other material do not count\n",
                 arguments.site.string());
    return track_on_soil::calibrate_on_site(
        site, {arguments.footprint[0], arguments.footprint[1], arguments.spacing}, options);
  }
  const soil::StoredMobility stored = soil::read_mobility(arguments.mobility);
  const std::string file = arguments.mobility.string();
  const track_on_soil::FootprintRow row = track_on_soil::footprints_of(stored, file);
  if (!arguments.footprint.empty() &&
      (arguments.footprint[0] != row.length || arguments.footprint[1] != row.width))
    throw InputError(
        fmt::format("{}: footprint of {:g} m x {:g} m, must be {:g} m x {:g} m as --footprint says", file,
                    row.length, row.width, arguments.footprint[0], arguments.footprint[1]));
  track_on_soil::SiteClm clm = track_on_soil::calibrate_on_mobility(
      stored, file, arguments.spacing > 0 ? arguments.spacing : row.spacing, options);
  if (const std::string mismatch = clm.find_mismatch(site, clm.row); !mismatch.empty())
    throw InputError(fmt::format("{}: cannot stand for {}: it {}", file, arguments.site.string(), mismatch));
  if (clm.knows_blocks() && !site.blocks.empty())
    fmt::print(
        stderr,
        "calibrate: warning: {}: by finite elements on a ground with blocks: coarse elements right below the "
        "footprint are too stiff by 5 % and more, and so is the foundation\n",
        file);
  return clm;
}

void print(const track_on_soil::SiteClm& clm) {
  const track::ClmFit& fit = clm.fit;
  fmt::print("ground      {}\n", fit.clm.k_f.source);
  fmt::print("footprints  {:g} m x {:g} m every {:g} m\n", clm.row.length, clm.row.width, clm.row.spacing);
  fmt::print("system      {}, {:g} to {:g} Hz, {} frequencies, each octave alike\n", fit.system, clm.lowest,
             clm.highest, fit.frequency.size());
  fmt::print(
      "  m_f  {:12.5g} kg\n  k_f  {:12.5g} N/m\n  d_f  {:12.5g} N s/m\n  k_c  {:12.5g} N/m\n"
      "  d_c  {:12.5g} N s/m\n",
      fit.clm.m_f.value, fit.clm.k_f.value, fit.clm.d_f.value, fit.clm.k_c.value, fit.clm.d_c.value);
  fmt::print("residual    {:.1f} % of H_00, {:.1f} % of H_01 (rms, of |H_00| at {:g} Hz)\n", 100 * fit.rms_00,
             100 * fit.rms_01, fit.frequency[0]);
  fmt::print("margins     (k_f + 4 k_c) / k_f = {:.3g}, (d_f + 4 d_c) / d_f = {:.3g}, m_f = {:.4g} kg\n",
             fit.stiffness_margin, fit.damping_margin, fit.clm.m_f.value);
  fmt::print("bounds      {}\n",
             fit.bounds.empty() ? "none is reached" : fmt::format("{}", fmt::join(fit.bounds, ", ")));
  if (fit.left_out > 0)
    fmt::print("left out    {:.1f} % of the ground's stiffness: couplings beyond neighbours\n",
               100 * fit.left_out);
}

void write_page(const Arguments& arguments, const track_on_soil::SiteClm& clm, const fs::path& path) {
  const track::ClmFit& fit = clm.fit;
  visu::Report report("Foundation of a track on its site", arguments.site.filename().string());
  report.add_facts({{"Ground", fit.clm.k_f.source.substr(3)},  // without the mark of its provenance

                    {"Footprints", fmt::format("{:g} m x {:g} m every {:g} m", clm.row.length, clm.row.width,
                                               clm.row.spacing)},
                    {"Fit", fmt::format("{}, {:g} to {:g} Hz, {} frequencies, each octave alike", fit.system,
                                        clm.lowest, clm.highest, fit.frequency.size())}});
  report.add_section("Constants, per sleeper");
  report.add_key_figures({{"mass m_f", number_text(fit.clm.m_f, 4), "kg"},
                          {"stiffness k_f", number_text(1e-6 * fit.clm.k_f, 4), "MN/m"},
                          {"damping d_f", number_text(1e-3 * fit.clm.d_f, 4), "kN s/m"},
                          {"coupling stiffness k_c", number_text(1e-6 * fit.clm.k_c, 4), "MN/m"},
                          {"coupling damping d_c", number_text(1e-3 * fit.clm.d_c, 4), "kN s/m"}});
  visu::Table quality{
      {"what", "value", "accepted"},
      {{"error of H_00, rms, of |H_00| at the lowest frequency [%]", number_text(100 * fit.rms_00, 3), ""},
       {"error of H_01, the same [%]", number_text(100 * fit.rms_01, 3), ""},
       {"(k_f + 4 k_c) / k_f", number_text(fit.stiffness_margin, 3), "at least 0"},
       {"(d_f + 4 d_c) / d_f", number_text(fit.damping_margin, 3), "at least 0"},
       {"m_f [kg]", number_text(fit.clm.m_f, 4), "at least 0"}},
      "How well the chain follows the ground, and how far it is from giving energy"};
  if (fit.left_out > 0)
    quality.rows.push_back({"couplings beyond neighbours, of the ground's stiffness [%]",
                            number_text(100 * fit.left_out, 3), ""});
  report.add_table(std::move(quality));
  if (!fit.bounds.empty())
    report.add_note(
        fmt::format("The fit lies on {}: the ground would have it beyond.", fmt::join(fit.bounds, " and ")));
  report.add_section("Compliance");
  report.add_charts(
      soil::draw_compliances({fit.frequency, fit.ground_00, fit.ground_01, fit.model_00, fit.model_01}));
  report.add_paragraph(
      "Five constants that do not depend on frequency cannot follow the resonance of a layer. How much that "
      "matters is "
      "seen after a prediction: its report compares the displacement of the foundation with that of the "
      "ground under "
      "every sleeper (recoupling error).");
  visu::Table layers{{"layer", "thickness [m]", "density [kg/m³]", "c_S [m/s]", "c_P [m/s]", "damping"},
                     {},
                     "Layers of the site"};
  for (const soil::Layer& layer : clm.layers)
    layers.rows.push_back({layer.name,
                           &layer == &clm.layers.back() ? "\u2013" : number_text(layer.thickness, 4),
                           number_text(layer.density, 4), number_text(layer.cs, 4), number_text(layer.cp, 4),
                           visu::short_number_text(layer.damping)});
  report.add_section("Ground").add_table(std::move(layers));
  report.write(path);
}

}  // namespace

int main(int argc, char** argv) {
  Arguments arguments;
  CLI::App app{
      "The foundation of a track from its site: five constants that follow the ground below the sleepers."};
  const auto positive = CLI::PositiveNumber.description("");
  app.add_option("SITE", arguments.site, "Site file (TOML)")->required()->type_name("");
  app.add_option("--footprint", arguments.footprint, "of a sleeper: length along the track, width [m]")
      ->expected(2)
      ->check(positive)
      ->type_name("LENGTH WIDTH");
  app.add_option("--spacing", arguments.spacing, "of the sleepers [m]")->check(positive);
  app.add_option("--band", arguments.band, "of the fit [Hz]")
      ->expected(2)
      ->check(positive)
      ->type_name("LOWEST HIGHEST")
      ->capture_default_str();
  app.add_option("--foundations", arguments.foundations,
                 "infinite: an endless chain; N: N footprints with free ends, 2 to 500")
      ->type_name("N|infinite")
      ->capture_default_str();
  app.add_option("--mobility", arguments.mobility,
                 "compliance from impulse responses (`soil mobility`) instead of the layers; footprint and "
                 "spacing are "
                 "those of the file")
      ->check(CLI::ExistingFile.description(""))
      ->type_name("FILE");
  app.add_option("--clm", arguments.clm, "file to write; default: SITE.clm.toml beside the site file")
      ->type_name("FILE");
  app.add_option("--output", arguments.output, "folder of calibration.html")->capture_default_str();
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    return app.exit(e) == 0 ? 0 : 2;
  }
  try {
    const track_on_soil::SiteClm clm = calibrate(arguments);
    print(clm);
    const fs::path file = arguments.clm.empty() ? track_on_soil::clm_file_of(arguments.site) : arguments.clm;
    write_clm(file, clm);
    fs::create_directories(arguments.output);
    write_page(arguments, clm, arguments.output / "calibration.html");
    fmt::print("wrote {} and {}\n", file.string(), (arguments.output / "calibration.html").string());
  } catch (const std::exception& e) {
    std::cerr << "calibrate: " << e.what() << "\n";
    return 1;
  }
}

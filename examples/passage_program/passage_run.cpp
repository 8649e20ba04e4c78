#include "examples/passage_program/passage_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "track/critical_speed.hpp"
#include "track/irregularity.hpp"
#include "track/profile_file.hpp"
#include "track/rolled_profile.hpp"

namespace easydyn::examples {

namespace {

using namespace easydyn::units;

/// The foundation asked for; the simpler ones keep the constants of the CLM and drop what they do not have.
track::Foundation choose_foundation(const std::string& name, const track::Foundation& bundled) {
  if (name == "rigid") return track::RigidGround{};
  if (name == "clm") return bundled;
  track::Clm c = track::as_clm(bundled);
  for (Sourced* constant : {&c.m_f, &c.k_f, &c.d_f})
    constant->source = "as in the fitted CLM, its coupling dropped: not a fit of its own";
  if (name == "winkler") return track::Winkler{c.k_f, c.d_f};
  return track::WinklerMass{c.m_f, c.k_f, c.d_f};
}

Course plan(const PassageProgram& program, double loaded, bool is_rough) {
  Course course{};
  for (const auto& gear : program.vehicle.gears)
    for (const auto& pair : gear.wheel_pairs) course.reach = std::max(course.reach, std::abs(pair.x));
  course.stop = loaded + program.approach + course.reach;
  course.start = -course.stop;
  course.run_in = is_rough ? 2 * course.reach + 25 * m : 25 * m;
  course.rough_begin = course.start - course.run_in + course.reach + 2 * m;
  return course;
}

/// What a wheel makes of a measured rail: the path of its centre. The ends are held.
std::shared_ptr<const track::Profile> roll_over(const track::SplineProfile& measured) {
  double spacing = measured.x().back() - measured.x().front();
  for (std::size_t i = 1; i < measured.x().size(); ++i)
    spacing = std::min(spacing, measured.x()[i] - measured.x()[i - 1]);
  return std::make_shared<track::RolledProfile>(
      "measured profile", std::make_shared<track::SplineProfile>(measured),
      track::RolledProfileOptions{.begin = measured.x().front(),
                                  .end = measured.x().back(),
                                  .step = std::clamp(spacing / 20, 2.5e-4, 5e-3)});
}

double static_load(const track::TrackContact& contact) {
  const auto* const wheel = dynamic_cast<const track::WheelRailContact*>(&contact);
  return wheel ? wheel->static_load() : contact.force();
}
}  // namespace

PassageRun::PassageRun(const PassageProgram& program, const PassageProgramOptions& options, double speed_)
    : is_rough(options.irregularity != "none" || !options.profile.empty()),
      speed(speed_),
      rayleigh_speed(program.rayleigh_speed),
      critical_speed(program.critical_speed),
      course(plan(program, options.loaded, is_rough || options.wheel_flat > 0)),
      data(program.track) {
  data.foundation = choose_foundation(options.foundation, data.foundation);

  // The sleepers are centred between the bays about x = 0, so that x = 0 is mid-span.
  const double spacing = data.sleeper_spacing;
  // What comes back from the ends of the window, 32 m away, matters more where wheels lift off.
  has_wide_margin = options.step_height != 0 || options.wheel_flat > 0 || !options.profile.empty();
  const double margin = program.margin + (has_wide_margin ? 14 * m : 0);
  const double beyond = course.reach + margin + 3 * spacing;
  const int bays_behind = static_cast<int>(std::ceil((course.stop + course.run_in + beyond) / spacing)),
            bays_ahead = static_cast<int>(std::ceil((course.stop + beyond) / spacing));
  const track::TrackModel model(data, bays_behind + bays_ahead + 1, -(bays_behind + 0.5) * spacing);

  // Excitation: the joint at x = 0, and what is rough all the way.
  std::vector<std::shared_ptr<const track::Profile>> parts;
  parts.push_back(std::make_shared<track::StepProfile>(0, options.step_height * mm));
  if (options.irregularity != "none") {
    const track::IrregularitySpectrum spectrum = track::irregularity_spectrum(options.irregularity);
    shortest_wave = spectrum.shortest_wavelength();
    parts.push_back(std::make_shared<track::Irregularity>(
        spectrum,
        track::IrregularityOptions{
            .begin = course.rough_begin, .end = course.stop + course.reach + 30 * m, .seed = options.seed}));
  }
  if (!options.profile.empty()) parts.push_back(roll_over(track::read_profile(options.profile)));
  profile = std::make_shared<track::ProfileSum>(parts);
  const std::shared_ptr<const track::WheelShape> flat =
      options.wheel_flat > 0
          ? std::make_shared<track::WheelFlat>(track::WheelFlat::rounded(options.wheel_flat * mm))
          : nullptr;
  system = std::make_unique<TrainOnTrack>(program.vehicle, model, course.start, speed, profile,
                                          options.detail, flat, course.rough_begin);

  passage_options.duration = (course.stop - course.start) / speed;
  passage_options.run_in = course.run_in / speed;
  passage_options.step = options.time_step;
  const double output_step = passage_options.duration > 6 * s ? 1e-3 : 5e-4;  // 0.5 kHz at least
  passage_options.output_step =
      std::max(1.0, std::round(output_step / options.time_step)) * options.time_step;
  passage_options.start_difference = std::min(2e-3, 0.05 * spacing / speed);
  passage_options.window = 2 * (course.reach + margin);
  passage_options.first_sleeper_x = -options.loaded - program.approach;
  passage_options.last_sleeper_x = options.loaded + program.approach;
}

void PassageRun::compute(const std::function<void(double)>& progress) {
  passage = track::compute_passage(*system, system->track, system->contacts(), passage_options, progress);
  if (passage.contact_losses.sum() > 0 && !has_wide_margin)
    passage.warnings.push_back(
        "wheels lift off: what comes back from the ends of the window, 32 m away, may be 2e-6 of the ballast "
        "reactions instead of 1e-6");
}

Eigen::VectorXd PassageRun::static_loads() const {
  const std::vector<const track::TrackContact*> contacts = system->contacts();
  Eigen::VectorXd loads(static_cast<Eigen::Index>(contacts.size()));
  for (std::size_t w = 0; w < contacts.size(); ++w)
    loads[static_cast<Eigen::Index>(w)] = static_load(*contacts[w]);
  return loads;
}
double PassageRun::largest_load_factor() const {
  double largest = 0;
  const std::vector<const track::TrackContact*> contacts = system->contacts();
  for (std::size_t w = 0; w < contacts.size(); ++w)
    largest = std::max(
        largest, passage.largest_contact_force[static_cast<Eigen::Index>(w)] / static_load(*contacts[w]));
  return largest;
}
double PassageRun::energy_imbalance() const {
  const Eigen::VectorXd energy =
      passage.kinetic_energy + passage.potential_energy + passage.dissipated_energy - passage.supplied_energy;
  return (energy.array() - energy[0]).abs().maxCoeff() / passage.supplied_energy.cwiseAbs().maxCoeff();
}

std::vector<track::SummaryFigure> PassageRun::summarise() const {
  double weight = 0;
  for (const track::TrackContact* contact : system->contacts()) weight += static_load(*contact);
  return {
      {"vehicle weight", weight / kN, "kN"},
      {"static sum of the ballast reactions / weight", passage.static_ballast_reaction / weight, ""},
      {"largest contact force", passage.largest_contact_force.maxCoeff() / kN, "kN"},
      {"largest dynamic load factor of a wheel pair", largest_load_factor(), ""},
      {"largest rail deflection", passage.rail_deflection.maxCoeff() / mm, "mm"},
      {"largest ballast reaction", passage.ballast_reaction.maxCoeff() / kN, "kN"},
      {"smallest ballast reaction", passage.ballast_reaction.minCoeff() / kN, "kN"},
      {"losses of contact", double(passage.contact_losses.sum()), ""},
      {"longest loss of contact of a wheel pair", passage.longest_contact_loss.maxCoeff() / ms, "ms"},
      {"energy imbalance / work supplied", energy_imbalance(), ""},
  };
}

std::vector<std::string> PassageRun::warn() const {
  std::vector<std::string> warnings;
  if (const auto warning = track::warn_of_critical_speed(data, speed)) warnings.push_back(*warning);
  if (rayleigh_speed > 0 && speed > 0.7 * rayleigh_speed)
    warnings.push_back(fmt::format(
        "speed {:.1f} m/s is {:.2f} of the Rayleigh speed {:.1f} m/s of the upper layer of the ground: {}; "
        "the "
        "foundation of the track, fitted at rest, does not know that",
        speed, speed / rayleigh_speed, rayleigh_speed,
        speed < rayleigh_speed ? "its waves gather around the train"
                               : "the train outruns its waves, which trail it as a wake"));
  if (critical_speed > 0 && speed > 0.7 * critical_speed)
    warnings.push_back(fmt::format(
        "speed {:.1f} m/s is {:.2f} of the critical speed {:.1f} m/s of the track on this ground, at which a "
        "moving load deflects it most",
        speed, speed / critical_speed, critical_speed));
  if (shortest_wave > 0 && speed / shortest_wave < 80)
    warnings.push_back(fmt::format(
        "the irregularity has no waves shorter than {:g} m: at {:.1f} m/s it excites nothing above {:.1f} Hz",
        shortest_wave, speed, speed / shortest_wave));
  return warnings;
}

}  // namespace easydyn::examples

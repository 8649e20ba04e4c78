#pragma once

#include <array>
#include <filesystem>
#include <limits>
#include <set>
#include <string>
#include <vector>

namespace easydyn::soil {

/// One layer of the ground, from its top downward; the last one is a half-space.
struct Layer {
  std::string name;
  double thickness = 0;  ///< [m], > 0; infinite for the half-space
  double density = 0;    ///< [kg/m3], > 0
  double cs = 0;         ///< shear wave speed [m/s], > 0
  double cp = 0;         ///< compression wave speed [m/s], > cs sqrt(4/3)
  double damping = 0;    ///< damping ratio at Site::damping_frequency, 0 <= damping < 0.2
  std::string source;    ///< provenance of the values

  double shear_modulus() const { return density * cs * cs; }
  double lame_lambda() const { return density * (cp * cp - 2 * cs * cs); }
  double poisson_ratio() const { return 0.5 * (cp * cp - 2 * cs * cs) / (cp * cp - cs * cs); }
};

/// A box of the ground, its faces along the axes, that is of another material or open (air): a trench, a filled
/// trench, a stiff inclusion. An embankment is a first layer of its material with open blocks beside it.
struct Block {
  std::string name;
  std::array<double, 2> x{
      -std::numeric_limits<double>::infinity(),
      std::numeric_limits<double>::infinity()};  ///< [m] infinite: to the edge of the model
  std::array<double, 2> y = x, z{};              ///< [m]; z finite and <= 0
  bool open = false;                             ///< air: `material` is not used
  bool mirrored = false;                         ///< its mirror image about y = 0 as well
  Layer material;                                ///< but for its thickness
};

/// A point where the ground motion is wanted; z <= 0 (0 = surface).
struct Receiver {
  std::string name;
  std::array<double, 3> position{};  ///< x, y, z [m]
  std::string group{};               ///< the line or grid that it belongs to; empty: none
};

/// A plane across an axis, x = c, y = c or z = c, whose motion is written as pictures (snapshot_writer.hpp).
struct Snapshot {
  std::string name;  ///< of its files
  int axis = 2;      ///< across the plane: 0, 1, 2 for x, y, z
  double place = 0;  ///< c [m]
  double step = 0;   ///< [s] > 0 between two pictures, made a whole number of output steps
  double begin = -std::numeric_limits<double>::infinity();  ///< [s]
  double end = std::numeric_limits<double>::infinity();     ///< [s]
};

/// Everything that `soil run` needs besides the loads: what site.toml holds.
struct Site {
  std::string name;
  std::vector<Layer> layers;  ///< at least one; the last is the half-space
  std::vector<Block> blocks;  ///< where two overlap, the later one holds
  std::vector<Receiver> receivers;
  std::vector<Snapshot> snapshots;
  double highest_frequency = 50;       ///< [Hz]; the mesh resolves it, nothing above it is claimed
  double damping_frequency = 20;       ///< [Hz] at which Layer::damping, cs and cp hold
  double points_per_wavelength = 5.5;  ///< shortest shear wavelength / mean GLL spacing
  double taper_length = 8;             ///< [m] over which loads fade out at both ends of the loaded track
  double margin = 3;                   ///< [m] of undamped ground around loads and receivers
  double duration = 0;                 ///< [s]; 0: as long as the loads, plus `decay_time`
  double decay_time = 0.5;             ///< [s]
  std::set<std::string> given;         ///< keys of the file's settings, e.g. "margin"; none: no file
  std::string text;                    ///< the file as read
};

/// Values that are possible but so rare in soils that a slip of the unit is likelier: one sentence each, empty
/// where nothing is unusual. Usual: density 1000 to 3000 kg/m3, cs 30 to 3000 m/s, damping 0.5 to 15 %.
std::vector<std::string> unusual_values(const Site& site);

}  // namespace easydyn::soil

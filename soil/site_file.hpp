#pragma once

#include <filesystem>
#include <string>

#include "soil/site.hpp"

namespace easydyn::soil {

/// Reads a site file (TOML): the layers of the ground, the receivers and the settings of the solver.
///
///     name = "Two layers"                     # optional: the name of the file
///     source = "where the values come from"   # optional, here and in every layer and receiver
///
///     [[layer]]                               # from the surface downward
///     name = "loam"                           # optional
///     thickness = 2.0                         # [m]; the last layer has none: it is a half-space
///     density = 1800                          # [kg/m3]
///     damping = 0.03                          # ratio at solver.damping_frequency, >= 0 and < 0.2
///     cs = 150                                # [m/s] shear wave speed, with cp [m/s] or nu
///     nu = 0.33                               # Poisson ratio, 0 to 0.4995, also where it follows from cp: below
///                                             # a water table cp is about 1500 m/s
///     # E = 1.1e8                             # [Pa] with nu, in place of cs; cs, cp and E hold at
///                                             # solver.damping_frequency
///     [[block]]                               # optional: a box of other material, or of air
///     name = "trench"                         # optional
///     x = [-10, 10]                           # [m] from, to; inf allowed; without x or y: through the model
///     y = [5, 6]
///     z = [-4, 0]                             # [m] at most 0
///     open = true                             # air; without it density, damping and stiffness as in a layer
///     mirrored = true                         # its mirror image about y = 0 as well: the half model asks for
///                                             # it unless the block lies as -y..y
///     [[receiver]]
///     name = "8 m"                            # a name of its own
///     distance = 8                            # [m] from the track's axis: (0, 8, 0)
///     # position = [0, 8, -1]                 # [m] in place of distance: x, y or x, y, z with z <= 0
///
///     [[receiver_line]]                       # evenly spaced, both ends included; "A (0, 5, 0)", ...
///     name = "A"                              # optional: "receiver_line 1"
///     from = [0, 5]                           # [m] x, y or x, y, z with z <= 0
///     to = [0, 45]                            # [m]
///     spacing = 2                             # [m], a whole number of times in the length; or count = 21
///     [[receiver_grid]]                       # parallel to the axes, from one corner to the opposite one
///     from = [-10, 5, 0]
///     to = [10, 25, 0]
///     spacing = [5, 5, 1]                     # [m] along each axis; or count = [5, 5, 1]
///
///     [[snapshot]]                            # optional: pictures of a plane, for ParaView
///     name = "surface"                        # optional: the name of its files
///     z = 0                                   # [m] the plane: one of x, y and z (<= 0)
///     step = 0.01                             # [s]
///     begin = 0                               # [s] optional, like end
///
///     [solver]                                # optional, like each of its keys
///     highest_frequency = 50                  # [Hz]
///     damping_frequency = 20                  # [Hz]
///     points_per_wavelength = 5.5             # 4 to 50
///     margin = 3                              # [m]
///
///     [loads]                                 # optional, like each of its keys
///     taper_length = 8                        # [m]
///     duration = 0                            # [s]; 0: as long as the loads, plus decay_time
///     decay_time = 0.5                        # [s]
///
/// @throws InputError `file:line:column: object: key = value, must be ...`; an unknown key is refused
///         with the nearest known one
Site read_site(const std::filesystem::path& path);

/// The same from the text of a site file, e.g. as a result keeps it; `path` is what error messages name.
Site parse_site(const std::string& text, const std::filesystem::path& path);

}  // namespace easydyn::soil

#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "easydyn/parameter.hpp"
#include "track/foundation.hpp"
#include "track/rail_beam.hpp"
#include "track/rail_section.hpp"

namespace easydyn::track {

/// Ends of the track that swallow the waves in the rail: in the last bays on each side, where t runs from 0
/// to 1 towards the end, the rail elements get the damping
///   C_e = t^3 (alpha M_e + beta K_e).
/// On `t2000_like` and `thalys_like` the defaults send back less than 1e-5 of the response at the load below 200 Hz,
/// and less than 1e-3 up to 700 Hz, for a load 5 m before the absorbing bays; on the other bundled tracks up to 2e-4
/// below 200 Hz (Lincent, which damps least).
struct AbsorbingEnds {
  int bays = 20;        ///< on each side, >= 0; 0 = plain free ends
  double alpha = 4000;  ///< [1/s], >= 0
  double beta = 2e-4;   ///< [s], >= 0
};

enum class RailTheory { euler_bernoulli, timoshenko };

/// Elastic layer below each sleeper, in series with the ballast.
struct UnderSleeperPads {
  Sourced stiffness;  ///< k_u [N/m], > 0
  Sourced damping;    ///< d_u [N s/m], >= 0
};

/// Ballast that moves: a mass per sleeper between the springs of the ballast and those of the ground below it
/// (subgrade), joined to its neighbours in shear.
///
///   sleeper -- (k_b, d_b) -- m_b -- (k_g, d_g) -- foundation,    m_b[j] -- (k_w, d_w) -- m_b[j+1]
///
/// Reference: W. M. Zhai, K. Y. Wang, J. H. Lin, Modelling and experiment of railway ballast vibrations, J. Sound
/// Vib. 270, 2004, doi:10.1016/S0022-460X(03)00186-2.
struct BallastMass {
  Sourced mass;                                        ///< m_b [kg], > 0
  Sourced base_stiffness;                              ///< k_g [N/m], > 0
  Sourced base_damping;                                ///< d_g [N s/m], >= 0
  Sourced shear_stiffness = {0, "no shear coupling"};  ///< k_w [N/m], >= 0
  Sourced shear_damping = {0, "no shear coupling"};    ///< d_w [N s/m], >= 0
};

/// Slab track: the sleepers are points of a continuous slab, a beam of Euler and Bernoulli with one element per
/// bay (width of the slab whole, both rails). The sleeper's displacement u_s is then the slab's deflection below
/// the fastening, the sleeper's mass what is fixed to the slab there (blocks; may be 0), and the "ballast" the
/// slab's bedding per spacing. Waves in a slab are long: 40 absorbing bays with alpha = 1500 1/s send back 3e-4 of the
/// response at the load below 200 Hz, the default 1e-2.
struct Slab {
  Sourced bending_stiffness;  ///< E I [N m2], > 0
  Sourced mass_per_length;    ///< [kg/m], > 0
};

/// What is special about the support below one sleeper.
struct SupportVariation {
  double pad = 1;         ///< factor on k_p and d_p, > 0
  double ballast = 1;     ///< factor on k_b and d_b, >= 0; on k_w and d_w the smaller of two neighbours
  double foundation = 1;  ///< factor on k_f, d_f, k_g, d_g, > 0; on k_c and d_c the smaller of two neighbours
  /// Clearance between the hanging sleeper and its ballast in the track without load, at rest [m], >= 0; 0 = the
  /// sleeper lies on the ballast. See hanging_sleepers.hpp.
  double gap = 0;
};

/// A straight track as a data sheet. All values hold for the WHOLE track (both rails together)
/// unless they say "per rail"; per sleeper where they are lumped.
///
///   rail -- (pad k_p, d_p) -- sleeper m_s -- [under-sleeper pad] -- (ballast k_b, d_b) -- [ballast mass] -- foundation
///
/// What stands in brackets is optional. Gravity acts on the vehicle only: the dead load of the track is already
/// in the ground.
struct TrackData {
  std::string name;
  RailSection rail;           ///< one rail
  int rails = 2;              ///< >= 1
  Sourced sleeper_spacing;    ///< [m], > 0
  Sourced pad_stiffness;      ///< k_p [N/m], > 0
  Sourced pad_damping;        ///< d_p [N s/m], >= 0
  Sourced sleeper_mass;       ///< m_s [kg], > 0 (>= 0 on a slab)
  Sourced ballast_stiffness;  ///< k_b [N/m], > 0
  Sourced ballast_damping;    ///< d_b [N s/m], >= 0
  Foundation foundation;      ///< default: rigid ground
  Sourced footprint_length;   ///< of a sleeper on the ground, along x [m], > 0
  Sourced footprint_width;    ///< along y [m], > 0
  int elements_per_bay = 4;   ///< rail elements between two sleepers, >= 1
  AbsorbingEnds ends;
  RailTheory theory = RailTheory::euler_bernoulli;
  std::optional<UnderSleeperPads> under_sleeper_pads;
  std::optional<BallastMass> ballast_mass;
  std::optional<Slab> slab;
  /// Support below sleeper number `sleeper` (from 0 at the begin of the model) at x [m]; empty: all alike.
  std::function<SupportVariation(int sleeper, double x)> variation;
  std::string variation_source = "set by the user";

  std::string label() const { return "track \"" + name + "\""; }  ///< for messages and tables
};

/// The rails together as one beam, by the theory chosen.
BeamProperties rail_beam(const TrackData& data);

/// Without the variation of supports, which the model checks sleeper by sleeper.
/// @throws ModelError naming the track, the quantity, its value and the accepted range
void validate(const TrackData& data);

/// Every value with its unit and its provenance, for the report; of a variation of supports only that there is one:
/// `parameters(const TrackModel&)` has its values.
std::vector<Parameter> parameters(const TrackData& data);

/// Representative of the Brussels tram network (not its owner's data): 50E2, sleepers every 0.72 m, CLM
/// fitted on layered ground of the Brussels tram class.
TrackData t2000_like_track();

/// Representative of the high-speed line at Ath (not its owner's data): 60E1, monoblock sleepers every 0.6 m,
/// CLM fitted on the layered ground of Ath.
TrackData thalys_like_track();

/// Ballast with mass, W. M. Zhai et al. 2004: CN60, sleepers every 0.6 m, ballast masses in shear, on the springs
/// of the subgrade above rigid ground.
TrackData zhai_2004_track();

/// Default of railFE: 60E1, B70 sleepers every 0.6 m, soft ballast on rigid ground.
TrackData railfe_default_track();

/// Representative of the high-speed line at Lincent (not its owner's data): 60E1, monoblock sleepers every 0.6 m,
/// stiff ballast on rigid ground: no CLM is bundled for its soil.
TrackData lincent_like_track();

}  // namespace easydyn::track

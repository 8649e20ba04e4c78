#pragma once

#include <Eigen/Core>
#include <complex>
#include <vector>

#include "soil/relaxation.hpp"
#include "soil/site.hpp"

namespace easydyn::soil {

/// How the moduli G and lambda of a layer depend on the frequency. Both take the same complex factor m(w); the
/// damping ratio xi = Im m / (2 Re m) is Layer::damping, and Re m = 1, at Site::damping_frequency, w0.
enum class GroundDamping {
  none,                    ///< m = 1
  stiffness_proportional,  ///< m = 1 + 2 i xi w / w0
  maxwell_body,  ///< that of the finite elements (relaxation.hpp): xi nearly constant over their band
  constant_q  ///< m = (i w / w0)^(2 g) / cos(pi g), tan(pi g) = 2 xi: xi the same at all frequencies, causal;
              ///< E. Kjartansson, J. Geophys. Res. 84(B9), 1979, doi:10.1029/JB084iB09p04737
};

/// One layer at one circular frequency.
struct LayerAtFrequency {
  double thickness = 0;      ///< [m]; infinite for the half-space
  std::complex<double> mu;   ///< shear modulus G [Pa]
  std::complex<double> ks2;  ///< (w / c_S)^2 [1/m2]; 0 in the static limit
  double speed_ratio2 = 0;   ///< (c_S / c_P)^2
};

/// A ground of horizontal, homogeneous, isotropic layers on a half-space, in the frequency domain. Time goes as
/// exp(i w t); w may be complex, Im w <= 0 (exponential window).
class LayeredGround {
 public:
  /// @throws ModelError if a value of a layer is out of its range
  LayeredGround(const Site& site, GroundDamping damping);

  std::size_t layer_count() const { return layers_.size(); }
  const std::vector<Layer>& layers() const { return layers_; }
  GroundDamping damping() const { return damping_; }
  double slowest_cs() const;      ///< [m/s] at the damping frequency
  double fastest_cp() const;      ///< [m/s] at the damping frequency
  double lowest_damping() const;  ///< smallest damping ratio of a layer; 0 for GroundDamping::none
  double depth() const;           ///< [m] of the top of the half-space
  double thinnest_layer() const;  ///< [m]; infinite for a homogeneous half-space
  /// @throws ModelError where the moduli vanish (w = 0 with GroundDamping::constant_q)
  std::vector<LayerAtFrequency> compute_layers(std::complex<double> w) const;

 private:
  std::complex<double> compute_modulus_factor(std::size_t layer, std::complex<double> w) const;

  std::vector<Layer> layers_;
  GroundDamping damping_;
  double reference_;                // [rad/s]
  std::vector<Relaxation> bodies_;  // of each layer, for maxwell_body
};

}  // namespace easydyn::soil

#include "soil/mobility_prediction.hpp"

#include "soil/layered/superposition.hpp"
#include "soil/mobility_identity.hpp"
#include "soil/prediction.hpp"

namespace easydyn::soil {

Vibrations predict_vibrations(const StoredMobility& stored, const SurfaceLoads& loads, int threads) {
  const Site& site = stored.site;
  const Mobility& m = stored.mobility;
  Vibrations v = describe_prediction(site, loads);
  v.method = "superposition of impulse responses by: " + stored.method;
  add_settings(v.parameters, site);
  for (const Parameter& row : stored.parameters) v.parameters.push_back(row);
  const auto number = [](GroundDamping damping) {
    return damping == GroundDamping::none                     ? 0.0
           : damping == GroundDamping::stiffness_proportional ? 1.0
           : damping == GroundDamping::maxwell_body           ? 2.0
                                                              : 3.0;
  };
  if (stored.method == layered_method) {
    v.parameters.push_back({"solver", "material damping (0 none, 1 stiffness, 2 constant, 3 constant Q)",
                            number(stored.damping), "1", "option"});
  }
  const std::string group = "impulse responses: " + stored.method;
  v.parameters.push_back(
      {group, "length of the responses", stored.window > 0 ? stored.window : m.window(), "s", "computed"});
  v.parameters.push_back({group, "step of the responses", m.step, "s", "computed"});
  v.parameters.push_back(
      {group, "distances of receivers", static_cast<double>(m.places.size()), "1", "computed"});
  v.parameters.push_back(
      {group, "distances of footprints", static_cast<double>(m.shifts.size()), "1", "computed"});
  set_motion(v, superpose(m, site, loads, {.threads = threads}));
  return v;
}

}  // namespace easydyn::soil

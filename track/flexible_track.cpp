#include "track/flexible_track.hpp"

namespace easydyn::track {

FlexibleTrack::FlexibleTrack(System& system, TrackModel model)
    : system_(system),
      model_(std::move(model)),
      structure_(system.structure(model_.data().label(), model_.M(), model_.C(), model_.K())) {}

Port FlexibleTrack::touch_rail(double x) const {
  const RailPoint point = model_.rail_point(x);
  PortShape shape;
  for (std::size_t i = 0; i < point.dof.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    shape.add(point.dof[i], point.shape.N[k], point.shape.dN[k]);
  }
  return system_.touch(structure_, shape);
}

Eigen::VectorXd FlexibleTrack::coordinates(const Eigen::VectorXd& q) const {
  int k = 0;
  while (system_.structures()[static_cast<std::size_t>(k)].get() != &structure_) ++k;
  return q.segment(system_.structure_offset(k), model_.size());
}

}  // namespace easydyn::track

#include "track/track_scene.hpp"

namespace easydyn::track {

void add_track(visu::Scene& scene, const Passage& passage, const TrackData& data,
               const std::vector<Eigen::Index>& rows, double rail_top, double gauge) {
  const double rail_height = 0.14, sleeper_height = 0.16;
  const auto upward = [&rows](const Eigen::MatrixXd& downward) {
    Eigen::MatrixXd z(static_cast<Eigen::Index>(rows.size()), downward.cols());
    for (std::size_t i = 0; i < rows.size(); ++i)
      z.row(static_cast<Eigen::Index>(i)) = -downward.row(rows[i]);
    return z;
  };
  for (double side : {-0.5, 0.5}) {
    visu::DeformingLine rail;
    rail.name = side < 0 ? "right rail" : "left rail";
    rail.x = passage.sleeper_x;
    rail.deflection = upward(passage.rail_deflection);
    rail.y = side * gauge;
    rail.height = rail_top - rail_height / 2;
    rail.width = rail_height;
    rail.colour = "#333333";
    scene.lines.push_back(std::move(rail));
  }
  visu::DeformingLine sleepers;
  sleepers.name = "sleepers";
  sleepers.x = passage.sleeper_x;
  sleepers.deflection = upward(passage.sleeper_displacement);
  sleepers.height = rail_top - rail_height - sleeper_height / 2;
  sleepers.block = Eigen::Vector3d(data.footprint_length, data.footprint_width, sleeper_height);
  sleepers.colour = "#997755";
  scene.lines.push_back(std::move(sleepers));
}

}  // namespace easydyn::track

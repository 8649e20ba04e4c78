#include "soil/layered/footprint_response.hpp"

#include <fmt/format.h>

#include <Eigen/SparseCore>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "easydyn/error.hpp"
#include "easydyn/require.hpp"
#include "soil/layered/gauss_rule.hpp"
#include "soil/layered/radial_response.hpp"
#include "soil/layered/static_half_space.hpp"

namespace easydyn::soil {
namespace {

using Eigen::Index;
using SparseRows = Eigen::SparseMatrix<double, Eigen::RowMajor>;

constexpr int points = 6;  // of a cell

struct WeightedPoint {
  double x, weight;
};

// Gauss's rule over [low, high], in cells that are no longer than their distance from `centre`, seen from `gap`
// off the line, nor than `longest`.
std::vector<WeightedPoint> make_graded_rule(double low, double high, double centre, double gap,
                                            double smallest, double longest) {
  static const GaussRule rule(points);
  std::vector<WeightedPoint> sum;
  const auto add_cell = [&](double a, double b) {
    for (int i = 0; i < points; ++i) {
      sum.push_back({(a + b) / 2 + (b - a) / 2 * rule.points(i), std::abs(b - a) / 2 * rule.weights(i)});
    }
  };
  const auto add_side = [&](double from, double to) {  // away from the centre
    const double sign = to > from ? 1 : -1;
    for (double at = from; sign * (to - at) > 0;) {
      const double length = std::min(std::max({std::hypot(at - centre, gap), smallest}), longest);
      double next = at + sign * length;
      if (sign * (to - next) < 0.3 * length) next = to;
      add_cell(at, next);
      at = next;
    }
  };
  const double start = std::clamp(centre, low, high);
  add_side(start, high);
  add_side(start, low);
  return sum;
}

// Distance of x from [-size / 2, size / 2].
double outside(double x, double size) {
  return std::max(0.0, std::abs(x) - size / 2);
}

// One row of the weights on the nodes of the radial grid.
class Row {
 public:
  explicit Row(Index size) : values_(Eigen::VectorXd::Zero(size)) {}
  void add(const RadialGrid::Weights& weights, double factor) {
    values_.segment<RadialGrid::points_per_panel>(weights.first) += factor * weights.values;
  }
  void move_to(std::vector<Eigen::Triplet<double>>& entries, Index row) {
    for (Index i = 0; i < values_.size(); ++i) {
      if (values_(i) != 0) entries.emplace_back(static_cast<int>(row), static_cast<int>(i), values_(i));
    }
    values_.setZero();
  }

 private:
  Eigen::VectorXd values_;
};

SparseRows make_rows(Index rows, Index columns, const std::vector<Eigen::Triplet<double>>& entries) {
  SparseRows matrix(rows, columns);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

void check_request(const FootprintRequest& request) {
  const std::string object = "footprint response";
  require_not_negative(object, "length", request.length, "m");
  require_not_negative(object, "width", request.width, "m");
  require_not_negative(object, "source depth", request.source_depth, "m");
  const bool is_point = request.length == 0 && request.width == 0;
  if (!is_point) {
    require_positive(object, "length", request.length, "m");
    require_positive(object, "width", request.width, "m");
    require(request.source_depth == 0, object, "source depth", request.source_depth, "m",
            "0 for a load on a rectangle");
  }
  if (is_point || request.direction != LoadDirection::down) {
    if (!request.means.empty()) {
      throw ModelError(object + ": means over footprints are for vertical loads on a rectangle");
    }
  }
  for (const auto& point : request.points) {
    require_finite(object, "x", point[0], "m");
    require_finite(object, "y", point[1], "m");
    require(point[2] <= 0, object, "z", point[2], "m", "<= 0");
    if (is_point && point[0] == 0 && point[1] == 0 && -point[2] == request.source_depth) {
      throw ModelError(object + ": the displacement under a point load is infinite");
    }
  }
  for (const Footprint& mean : request.means) {
    require_positive(object, "length of a mean", mean.length, "m");
    require_positive(object, "width of a mean", mean.width, "m");
    require_finite(object, "x of a mean", mean.x, "m");
    require_finite(object, "y of a mean", mean.y, "m");
  }
}

class Response {
 public:
  Response(const LayeredGround& ground, const FootprintRequest& request, const Eigen::VectorXcd& w)
      : ground_(ground), request_(request), w_(w) {
    // A load along y is one along x after a quarter turn.
    if (request_.direction == LoadDirection::y) {
      std::swap(request_.length, request_.width);
      for (auto& point : request_.points) point = {point[1], -point[0], point[2]};
    }
    nu_ = ground.layers().front().poisson_ratio();
    is_point_ = request_.length == 0;
    for (const auto& point : request_.points) {
      const double depth = std::abs(point[2]);
      if (std::find(depths_.begin(), depths_.end(), depth) == depths_.end()) depths_.push_back(depth);
    }
    if (!request_.means.empty() && std::find(depths_.begin(), depths_.end(), 0.0) == depths_.end()) {
      depths_.push_back(0);
    }
    // The slowest waves are Rayleigh waves, c_R >= 0.86 c_S, at the highest frequency.
    double ks = 0;
    if (w.size() > 0) {
      for (const LayerAtFrequency& layer : ground.compute_layers(w(w.size() - 1))) {
        ks = std::max(ks, std::sqrt(layer.ks2).real());
      }
    }
    largest_wavenumber_ = 1.17 * ks;
    find_range();
  }

  FootprintResponse compute() {
    const Index nf = w_.size();
    FootprintResponse out;
    for (Eigen::MatrixXcd* u : {&out.ux, &out.uy, &out.uz})
      u->resize(nf, static_cast<Index>(request_.points.size()));
    out.mean.resize(nf, static_cast<Index>(request_.means.size()));
    if (nf == 0 || depths_.empty()) return out;
    const RadialGrid grid(smallest_ / 4, largest_, largest_wavenumber_);
    const bool down = request_.direction == LoadDirection::down;
    const std::vector<RadialResponse> radial =
        compute_radial_responses(ground_,
                                 {.source_depth = request_.source_depth,
                                  .receiver_depths = depths_,
                                  .vertical = down,
                                  .horizontal = !down,
                                  .smallest = smallest_,
                                  .threads = request_.threads},
                                 grid, w_);
    flexibility_.resize(nf);  // 1 / G of the uppermost layer
    for (Index i = 0; i < nf; ++i) flexibility_(i) = 1.0 / ground_.compute_layers(w_(i)).front().mu;
    for (std::size_t d = 0; d < depths_.size(); ++d) add_points(d, radial[d], grid, out);
    if (!request_.means.empty()) {
      const auto surface = std::find(depths_.begin(), depths_.end(), 0.0) - depths_.begin();
      add_means(radial[static_cast<std::size_t>(surface)], grid, out);
    }
    if (request_.direction == LoadDirection::y) {  // turn back
      out.ux.swap(out.uy);
      out.ux *= -1;
    }
    return out;
  }

 private:
  void find_range() {
    const double half = std::hypot(request_.length, request_.width) / 2;
    smallest_ = std::numeric_limits<double>::infinity();
    if (!is_point_) smallest_ = std::min(request_.length, request_.width) / 4;
    for (const auto& point : request_.points) {
      const double r = std::hypot(point[0], point[1]);
      largest_ = std::max(largest_, r + half);
      if (is_point_) {
        smallest_ = std::min(smallest_, std::max(r, 1.5 * std::abs(point[2] + request_.source_depth)));
      } else if (point[2] < 0) {
        smallest_ = std::min(smallest_, std::max(outside(r, 2 * half), 1.5 * std::abs(point[2])));
      }
    }
    for (const Footprint& mean : request_.means) {
      largest_ =
          std::max(largest_, std::hypot(mean.x, mean.y) + half + std::hypot(mean.length, mean.width) / 2);
      smallest_ = std::min(smallest_, std::min(mean.length, mean.width) / 4);
    }
    smallest_ = std::min(smallest_, 3 * ground_.thinnest_layer());
    largest_ = std::max(1.0001 * largest_, 4 * smallest_);
  }

  // Points of the source, seen from (x, y) at a depth.
  struct SourcePoint {
    double x, y, weight;
  };
  std::vector<SourcePoint> make_source(double x, double y, double depth, double smallest) const {
    if (is_point_) return {{0, 0, 1}};
    const double L = request_.length, B = request_.width, longest = 4 / std::max(largest_wavenumber_, 1e-9);
    const double gap_x = std::hypot(depth, outside(y, B)), gap_y = std::hypot(depth, outside(x, L));
    const auto along = make_graded_rule(-L / 2, L / 2, x, gap_x, smallest * L, longest);
    const auto across = make_graded_rule(-B / 2, B / 2, y, gap_y, smallest * B, longest);
    std::vector<SourcePoint> source;
    for (const WeightedPoint& a : along) {
      for (const WeightedPoint& b : across) source.push_back({a.x, b.x, a.weight * b.weight / (L * B)});
    }
    return source;
  }

  // Static displacement times the shear modulus: x, y, z up.
  std::array<double, 3> compute_static(const std::array<double, 3>& point) const {
    const double x = point[0], y = point[1], depth = -point[2];
    const bool down = request_.direction == LoadDirection::down;
    if (!is_point_ && depth == 0) {
      const auto s = compute_static_rectangle_response(nu_, request_.length, request_.width, x, y);
      return down ? std::array{s.xz, s.yz, -s.zz} : std::array{s.xx, s.yx, -s.zx};
    }
    std::array<double, 3> u{};
    for (const SourcePoint& p : make_source(x, y, depth, 1e-6)) {
      const double dx = x - p.x, dy = y - p.y, r = std::hypot(dx, dy);
      const double c = r > 0 ? dx / r : 1, s = r > 0 ? dy / r : 0;
      const StaticPointResponse g = compute_static_point_response(nu_, r, depth);
      if (down) {
        u[0] += p.weight * c * g.xz;
        u[1] += p.weight * s * g.xz;
        u[2] -= p.weight * g.zz;
      } else {
        u[0] += p.weight * (g.sum - g.difference * (c * c - s * s));
        u[1] -= p.weight * g.difference * 2 * c * s;
        u[2] += p.weight * c * g.zx;
      }
    }
    return u;
  }

  void add_points(std::size_t d, const RadialResponse& radial, const RadialGrid& grid,
                  FootprintResponse& out) {
    std::vector<Index> members;
    for (std::size_t p = 0; p < request_.points.size(); ++p) {
      if (std::abs(request_.points[p][2]) == depths_[d]) members.push_back(static_cast<Index>(p));
    }
    const bool down = request_.direction == LoadDirection::down;
    const auto count = static_cast<Index>(members.size());
    const Index nodes = grid.nodes().size();
    Eigen::MatrixXd fixed = Eigen::MatrixXd::Zero(count, 3);  // static, times the modulus
    // Two functions at most make a component.
    std::array<std::vector<Eigen::Triplet<double>>, 3> entries, entries_sum;
    Row rows[3] = {Row(nodes), Row(nodes), Row(nodes)}, row_sum(nodes);
    for (Index m = 0; m < count; ++m) {
      const auto& point = request_.points[static_cast<std::size_t>(members[static_cast<std::size_t>(m)])];
      const double depth = std::abs(point[2]);
      const double smallest = radial.static_part ? 1.0 / 8 : 1e-6;
      for (const SourcePoint& p : make_source(point[0], point[1], radial.static_part ? 0 : depth, smallest)) {
        const double dx = point[0] - p.x, dy = point[1] - p.y, r = std::hypot(dx, dy);
        const double c = r > 0 ? dx / r : 0, s = r > 0 ? dy / r : 0;
        const RadialGrid::Weights weights = grid.compute_weights(r);
        if (down) {
          rows[0].add(weights, p.weight * c);
          rows[1].add(weights, p.weight * s);
          rows[2].add(weights, -p.weight);
        } else {
          row_sum.add(weights, p.weight);
          rows[0].add(weights, -p.weight * (c * c - s * s));
          rows[1].add(weights, -p.weight * 2 * c * s);
          rows[2].add(weights, p.weight * c);
        }
      }
      for (std::size_t i = 0; i < 3; ++i) rows[i].move_to(entries[i], m);
      row_sum.move_to(entries_sum[0], m);
      if (radial.static_part) {
        const auto u = compute_static(point);
        fixed.row(m) << u[0], u[1], u[2];
      }
    }
    const std::array<const Eigen::MatrixXd*, 3> functions =
        down ? std::array{&radial.xz, &radial.xz, &radial.zz}
             : std::array{&radial.difference, &radial.difference, &radial.zx};
    const std::array<Eigen::MatrixXcd*, 3> u{&out.ux, &out.uy, &out.uz};
    for (std::size_t i = 0; i < 3; ++i) {
      Eigen::MatrixXd sum = make_rows(count, nodes, entries[i]) * *functions[i];
      if (!down && i == 0) sum += make_rows(count, nodes, entries_sum[0]) * radial.sum;
      put(sum, fixed.col(static_cast<Index>(i)), members, *u[i]);
    }
  }

  void add_means(const RadialResponse& radial, const RadialGrid& grid, FootprintResponse& out) {
    const auto count = static_cast<Index>(request_.means.size());
    const Index nodes = grid.nodes().size();
    std::vector<Eigen::Triplet<double>> entries;
    Eigen::VectorXd fixed(count);
    Row row(nodes);
    std::vector<Index> members;
    for (Index m = 0; m < count; ++m) {
      const Footprint& mean = request_.means[static_cast<std::size_t>(m)];
      const auto along = make_difference_rule(request_.length, mean.length, mean.x,
                                              outside(mean.y, request_.width + mean.width));
      const auto across = make_difference_rule(request_.width, mean.width, mean.y,
                                               outside(mean.x, request_.length + mean.length));
      for (const WeightedPoint& a : along) {
        for (const WeightedPoint& b : across) {
          row.add(grid.compute_weights(std::hypot(a.x, b.x)), a.weight * b.weight);
        }
      }
      row.move_to(entries, m);
      fixed(m) = compute_static_rectangle_mean(nu_, request_.length, request_.width, mean.length, mean.width,
                                               mean.x, mean.y);
      members.push_back(m);
    }
    put(make_rows(count, nodes, entries) * radial.zz, fixed, members, out.mean);
  }

  // Rule for the difference of two places, each uniform in a segment, whose centres are `offset` apart: the
  // density is a trapezium.
  std::vector<WeightedPoint> make_difference_rule(double from, double to, double offset, double gap) const {
    const double shorter = std::min(from, to), longer = std::max(from, to);
    const double breaks[4] = {-(longer + shorter) / 2, -(longer - shorter) / 2, (longer - shorter) / 2,
                              (longer + shorter) / 2};
    const double longest = 4 / std::max(largest_wavenumber_, 1e-9);
    std::vector<WeightedPoint> sum;
    for (int i = 0; i < 3; ++i) {
      if (breaks[i + 1] - breaks[i] < 1e-12 * longer) continue;
      for (const WeightedPoint& p :
           make_graded_rule(breaks[i], breaks[i + 1], -offset, gap, shorter / 8, longest)) {
        const double overlap = std::min(shorter, (longer + shorter) / 2 - std::abs(p.x));
        sum.push_back({offset + p.x, p.weight * overlap / (from * to)});
      }
    }
    return sum;
  }

  // From rows of places, columns (real, imaginary) to rows of frequencies; adds the static part.
  void put(const Eigen::MatrixXd& sum, const Eigen::VectorXd& fixed, const std::vector<Index>& members,
           Eigen::MatrixXcd& out) const {
    for (Index i = 0; i < out.rows(); ++i) {
      for (Index m = 0; m < sum.rows(); ++m) {
        out(i, members[static_cast<std::size_t>(m)]) =
            std::complex<double>(sum(m, 2 * i), sum(m, 2 * i + 1)) + fixed(m) * flexibility_(i);
      }
    }
  }

  const LayeredGround& ground_;
  FootprintRequest request_;
  const Eigen::VectorXcd& w_;
  double nu_ = 0, largest_wavenumber_ = 0, smallest_ = 0, largest_ = 0;
  bool is_point_ = false;
  std::vector<double> depths_;
  Eigen::VectorXcd flexibility_;
};

}  // namespace

FootprintResponse compute_footprint_response(const LayeredGround& ground, const FootprintRequest& request,
                                             const Eigen::VectorXcd& w) {
  check_request(request);
  return Response(ground, request, w).compute();
}

Eigen::MatrixXcd compute_compliances(const LayeredGround& ground, double length, double width, double spacing,
                                     int count, const Eigen::VectorXd& frequencies, int threads) {
  require_positive("compliances", "spacing", spacing, "m");
  require_positive("compliances", "count", count, "");
  FootprintRequest request;
  request.length = length;
  request.width = width;
  request.threads = threads;
  for (int n = 0; n < count; ++n) request.means.push_back({spacing * n, 0, length, width});
  return compute_footprint_response(ground, request,
                                    (2 * std::numbers::pi * frequencies).cast<std::complex<double>>())
      .mean;
}

}  // namespace easydyn::soil

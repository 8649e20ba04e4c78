#include "soil/layered/footprint_response.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "easydyn/error.hpp"
#include "easydyn/require.hpp"
#include "soil/layered/gauss_rule.hpp"
#include "soil/layered/radial_response.hpp"
#include "soil/layered/static_half_space.hpp"
#include "soil/parallel_loop.hpp"

namespace easydyn::soil {
namespace {

using Eigen::Index;

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

// Weights of the nodes of the radial grid, of which a place needs a few panels in a row.
class NodeWeights {
 public:
  explicit NodeWeights(Index size) : values_(Eigen::VectorXd::Zero(size)) {}
  void add(const RadialGrid::Weights& weights, double factor) {
    constexpr Index n = RadialGrid::points_per_panel;
    values_.segment<n>(weights.first) += factor * weights.values;
    begin_ = begin_ == end_ ? weights.first : std::min(begin_, weights.first);
    end_ = std::max(end_, weights.first + n);
  }
  // Weighted sum of the rows of `functions`; forgets the weights.
  Eigen::VectorXd sum_up(const Eigen::MatrixXd& functions) {
    const Index count = end_ - begin_;
    const Eigen::VectorXd sum =
        functions.middleRows(begin_, count).transpose() * values_.segment(begin_, count);
    values_.segment(begin_, count).setZero();
    begin_ = end_ = 0;
    return sum;
  }

 private:
  Eigen::VectorXd values_;
  Index begin_ = 0, end_ = 0;  // of the nodes with a weight
};

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
  if (is_point && !request.means.empty()) {
    throw ModelError(object + ": means over footprints are for loads on a rectangle");
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
      for (Footprint& mean : request_.means) mean = {mean.y, -mean.x, mean.width, mean.length};
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
    const bool down = request_.direction == LoadDirection::down;
    out.mean.resize(nf, static_cast<Index>(request_.means.size()));
    if (!down) {
      out.mean_x.resize(nf, out.mean.cols());
      out.mean_y.resize(nf, out.mean.cols());
    }
    if (nf == 0 || depths_.empty()) return out;
    const RadialGrid grid(smallest_ / 4, largest_, largest_wavenumber_);
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
      out.mean_x.swap(out.mean_y);
      out.mean_x *= -1;
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
    const double smallest = radial.static_part ? 1.0 / 8 : 1e-6;
    for_each_chunk(
        static_cast<Index>(members.size()), count_threads(request_.threads), [&](Index begin, Index end) {
          const Index nodes = grid.nodes().size();
          // Two functions at most make a component.
          NodeWeights x(nodes), y(nodes), z(nodes), x_sum(nodes);
          for (Index m = begin; m < end; ++m) {
            const Index place = members[static_cast<std::size_t>(m)];
            const auto& point = request_.points[static_cast<std::size_t>(place)];
            const double depth = radial.static_part ? 0 : std::abs(point[2]);
            for (const SourcePoint& p : make_source(point[0], point[1], depth, smallest)) {
              const double dx = point[0] - p.x, dy = point[1] - p.y, r = std::hypot(dx, dy);
              const double c = r > 0 ? dx / r : 0, s = r > 0 ? dy / r : 0;
              const RadialGrid::Weights weights = grid.compute_weights(r);
              if (down) {
                x.add(weights, p.weight * c);
                y.add(weights, p.weight * s);
                z.add(weights, -p.weight);
              } else {
                x_sum.add(weights, p.weight);
                x.add(weights, -p.weight * (c * c - s * s));
                y.add(weights, -p.weight * 2 * c * s);
                z.add(weights, p.weight * c);
              }
            }
            const std::array<double, 3> fixed =
                radial.static_part ? compute_static(point) : std::array<double, 3>{};
            if (down) {
              put(x.sum_up(radial.xz), fixed[0], out.ux.col(place));
              put(y.sum_up(radial.xz), fixed[1], out.uy.col(place));
              put(z.sum_up(radial.zz), fixed[2], out.uz.col(place));
            } else {
              put(x_sum.sum_up(radial.sum) + x.sum_up(radial.difference), fixed[0], out.ux.col(place));
              put(y.sum_up(radial.difference), fixed[1], out.uy.col(place));
              put(z.sum_up(radial.zx), fixed[2], out.uz.col(place));
            }
          }
        });
  }

  void add_means(const RadialResponse& radial, const RadialGrid& grid, FootprintResponse& out) {
    const auto update = [&](Index begin, Index end) {
      const Index nodes = grid.nodes().size();
      NodeWeights x(nodes), y(nodes), z(nodes), x_sum(nodes);
      for (Index m = begin; m < end; ++m) {
        const Footprint& mean = request_.means[static_cast<std::size_t>(m)];
        const auto along = make_difference_rule(request_.length, mean.length, mean.x,
                                                outside(mean.y, request_.width + mean.width));
        const auto across = make_difference_rule(request_.width, mean.width, mean.y,
                                                 outside(mean.x, request_.length + mean.length));
        const bool down = request_.direction == LoadDirection::down;
        for (const WeightedPoint& a : along) {
          for (const WeightedPoint& b : across) {
            const double r = std::hypot(a.x, b.x), weight = a.weight * b.weight;
            const RadialGrid::Weights weights = grid.compute_weights(r);
            if (down) {
              z.add(weights, weight);
              continue;
            }
            const double c = r > 0 ? a.x / r : 0, s = r > 0 ? b.x / r : 0;
            x_sum.add(weights, weight);
            x.add(weights, -weight * (c * c - s * s));
            y.add(weights, -weight * 2 * c * s);
            z.add(weights, -weight * c);
          }
        }
        if (down) {
          put(z.sum_up(radial.zz),
              compute_static_rectangle_mean(nu_, request_.length, request_.width, mean.length, mean.width,
                                            mean.x, mean.y),
              out.mean.col(m));
          continue;
        }
        const std::array<double, 3> fixed = compute_static_mean(mean);
        put(x_sum.sum_up(radial.sum) + x.sum_up(radial.difference), fixed[0], out.mean_x.col(m));
        put(y.sum_up(radial.difference), fixed[1], out.mean_y.col(m));
        put(z.sum_up(radial.zx), fixed[2], out.mean.col(m));
      }
    };
    for_each_chunk(static_cast<Index>(request_.means.size()), count_threads(request_.threads), update);
  }

  // Static mean over a footprint under a load along x, times the shear modulus: x, y, downward. By Gauss's rule,
  // near the load in cells that shrink towards the edges, where the displacement has infinite slopes.
  std::array<double, 3> compute_static_mean(const Footprint& mean) const {
    static const GaussRule rule(points);
    const double size = std::max({request_.length, request_.width, mean.length, mean.width});
    const std::vector<double> edges = std::hypot(mean.x, mean.y) > 5 * size
                                          ? std::vector<double>{0, 1}
                                          : std::vector<double>{0,     0.003, 0.03,  0.125, 0.25,  0.375, 0.5,
                                                                0.625, 0.75,  0.875, 0.97,  0.997, 1};
    std::vector<WeightedPoint> segment;  // of [-1/2, 1/2]
    for (std::size_t e = 0; e + 1 < edges.size(); ++e) {
      const double length = edges[e + 1] - edges[e];
      for (int i = 0; i < points; ++i)
        segment.push_back({edges[e] + length / 2 * (1 + rule.points(i)) - 0.5, length / 2 * rule.weights(i)});
    }
    std::array<double, 3> u{};
    for (const WeightedPoint& a : segment) {
      for (const WeightedPoint& b : segment) {
        const StaticRectangleResponse s = compute_static_rectangle_response(
            nu_, request_.length, request_.width, mean.x + a.x * mean.length, mean.y + b.x * mean.width);
        const double weight = a.weight * b.weight;
        u = {u[0] + weight * s.xx, u[1] + weight * s.yx, u[2] + weight * s.zx};
      }
    }
    return u;
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

  // From real and imaginary parts, one after the other, to frequencies; adds the static part.
  void put(const Eigen::VectorXd& parts, double fixed, Eigen::Ref<Eigen::VectorXcd> out) const {
    for (Index i = 0; i < out.size(); ++i)
      out(i) = std::complex<double>(parts(2 * i), parts(2 * i + 1)) + fixed * flexibility_(i);
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

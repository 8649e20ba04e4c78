#include "soil/layered/radial_response.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numbers>

#include "easydyn/error.hpp"
#include "soil/layered/bessel.hpp"
#include "soil/layered/gauss_rule.hpp"
#include "soil/layered/static_half_space.hpp"
#include "soil/layered/wavenumber_response.hpp"
#include "soil/parallel_loop.hpp"

namespace easydyn::soil {
namespace {

using Complex = std::complex<double>;
using Eigen::Index;
constexpr double pi = std::numbers::pi;

constexpr int points = 16;           // of a panel
constexpr double panel_phase = 26;   // largest k r over a panel: 16 points integrate exp(i k r) to 1e-8
constexpr double panel_reach = 3.3;  // largest length of a panel over the distance of the nearest pole: 1e-8
constexpr double cut_phase = 72;     // k r over which the integral ends

// Smooth end of the integral: 1 up to K1, 0 from K1 + width.
double compute_cut(double k, double K1, double width) {
  const double part = (k - K1) / width;
  return part <= 0 ? 1 : part >= 1 ? 0 : 0.5 * std::erfc(4.2 * (2 * part - 1));
}

// Where poles and branch points lie: wavenumbers lowest ... highest, off the axis by `slope` times k.
struct Singularities {
  double lowest = std::numeric_limits<double>::infinity(), highest = 0, slope = 1;

  // From a point of the real axis.
  double compute_distance(double k) const {
    if (highest == 0) return std::numeric_limits<double>::infinity();
    const double nearest = std::clamp(k, lowest, highest);
    return std::hypot(k - nearest, slope * nearest);
  }
};

Singularities find_singularities(const LayeredGround& ground, const Eigen::VectorXcd& w, Index first,
                                 Index last) {
  Singularities s;
  for (const Index i : {first, (first + last) / 2, last}) {
    if (w(i) == 0.0) continue;
    for (const LayerAtFrequency& layer : ground.compute_layers(w(i))) {
      const Complex ks = std::sqrt(layer.ks2);
      const double slope = std::min(1.0, std::abs(ks.imag()) / std::max(std::abs(ks.real()), 1e-300));
      s.slope = std::min(s.slope, slope);
      const double along = std::abs(ks) / std::hypot(1, slope);
      s.lowest = std::min(s.lowest, along * std::sqrt(layer.speed_ratio2));
      s.highest = std::max(s.highest, 1.2 * along);  // Rayleigh waves: c_R >= 0.874 c_S
    }
    if (!(s.slope > 1e-5)) {
      throw ModelError(
          fmt::format("layered ground: waves at {:.4g} Hz are undamped: give every layer a damping ratio "
                      ">= 1e-5, or use a complex frequency (exponential window)",
                      w(i).real() / (2 * pi)));
    }
  }
  return s;
}

struct Nodes {
  std::vector<double> k, weight;
  double K1 = 0;  // beyond the waves: from here the integral ends
};

// Panels from 0 to where the smallest distance no longer asks for more.
Nodes make_nodes(const Singularities& s, double largest_distance, double depth, double smallest) {
  static const GaussRule rule(points);
  Nodes nodes;
  const double reach = largest_distance + 2 * depth;  // waves down to the half-space and back
  nodes.K1 = 1.25 * s.highest;
  const double end = nodes.K1 + cut_phase / smallest;
  double k = 0;
  while (k < end) {
    // From K1 on only distances below cut_phase / (k - K1) are still at work.
    const double phase_reach = k > nodes.K1 ? std::min(reach, cut_phase / (k - nodes.K1)) : reach;
    double width = panel_phase / phase_reach;
    for (int pass = 0; pass < 4; ++pass) {
      width =
          std::min(width, panel_reach * std::min({s.compute_distance(k), s.compute_distance(k + width / 2),
                                                  s.compute_distance(k + width)}));
    }
    for (int i = 0; i < points; ++i) {
      nodes.k.push_back(k + width / 2 * (1 + rule.points(i)));
      nodes.weight.push_back(width / 2 * rule.weights(i));
    }
    k += width;
  }
  return nodes;
}

// The five transforms at one depth, nodes x (real, imaginary part at each frequency).
struct Kernels {
  Eigen::MatrixXd zz, xz, sum, difference, zx;
};

class Synthesis {
 public:
  Synthesis(const LayeredGround& ground, const RadialRequest& request, const RadialGrid& grid,
            const Eigen::VectorXcd& w)
      : ground_(ground), request_(request), grid_(grid), w_(w) {
    threads_ = count_threads(request.threads);
    responses_.resize(request.receiver_depths.size());
    const double top_end = ground.layers().front().thickness;
    for (std::size_t d = 0; d < responses_.size(); ++d) {
      RadialResponse& response = responses_[d];
      response.static_part = request.source_depth == 0 && request.receiver_depths[d] < top_end;
      const Index rows = grid.nodes().size(), columns = 2 * w.size();
      if (request.vertical) {
        response.zz = Eigen::MatrixXd::Zero(rows, columns);
        response.xz = response.zz;
      }
      if (request.horizontal) {
        response.sum = Eigen::MatrixXd::Zero(rows, columns);
        response.difference = response.sum;
        response.zx = response.sum;
      }
    }
  }

  std::vector<RadialResponse> run() {
    // Frequencies of one octave share the panels.
    for (Index first = 0; first < w_.size();) {
      Index last = first;
      while (last + 1 < w_.size() && std::abs(w_(last + 1)) <= 2 * std::abs(w_(first))) ++last;
      add_block(first, last);
      first = last + 1;
    }
    return std::move(responses_);
  }

 private:
  void add_block(Index first, Index last) {
    const Nodes nodes = make_nodes(find_singularities(ground_, w_, first, last), grid_.largest(),
                                   ground_.depth(), request_.smallest);
    const auto count = static_cast<Index>(nodes.k.size());
    const Index columns = 2 * (last - first + 1);
    std::vector<Kernels> kernels(responses_.size());
    for (Kernels& k : kernels) {
      if (request_.vertical) {
        k.zz.resize(count, columns);
        k.xz.resize(count, columns);
      }
      if (request_.horizontal) {
        k.sum.resize(count, columns);
        k.difference.resize(count, columns);
        k.zx.resize(count, columns);
      }
    }
    for_each_parallel(last - first + 1, threads_,
                      [&](Index i) { update_kernels(w_(first + i), nodes, 2 * i, kernels); });
    constexpr Index rows = 48;
    for_each_parallel((grid_.nodes().size() + rows - 1) / rows, threads_, [&](Index chunk) {
      add_distances(nodes, kernels, rows * chunk, std::min(rows, grid_.nodes().size() - rows * chunk),
                    2 * first, columns);
    });
  }

  // Kernels at one frequency, with the weights of the quadrature.
  void update_kernels(Complex w, const Nodes& nodes, Index column, std::vector<Kernels>& kernels) const {
    const std::vector<LayerAtFrequency> layers = ground_.compute_layers(w);
    WavenumberResponse response(layers, request_.source_depth, request_.receiver_depths);
    std::vector<WavenumberCompliance> G(responses_.size());
    const Complex mu = layers.front().mu;
    const double nu = ground_.layers().front().poisson_ratio();
    for (std::size_t n = 0; n < nodes.k.size(); ++n) {
      const double k = nodes.k[n], scale = k * nodes.weight[n] / (2 * pi);
      response.update(k, G.data());
      for (std::size_t d = 0; d < G.size(); ++d) {
        WavenumberCompliance& g = G[d];
        if (responses_[d].static_part) {
          const StaticCompliance s = compute_static_compliance(nu, k, request_.receiver_depths[d]);
          g = {g.xx - s.xx / mu, g.xz - s.xz / mu, g.zx - s.zx / mu, g.zz - s.zz / mu, g.yy - s.yy / mu};
        }
        const auto put = [&](Eigen::MatrixXd& kernel, Complex value) {
          kernel(static_cast<Index>(n), column) = scale * value.real();
          kernel(static_cast<Index>(n), column + 1) = scale * value.imag();
        };
        if (request_.vertical) {
          put(kernels[d].zz, g.zz);
          put(kernels[d].xz, g.xz);
        }
        if (request_.horizontal) {
          put(kernels[d].sum, 0.5 * (g.xx + g.yy));
          put(kernels[d].difference, 0.5 * (g.xx - g.yy));
          put(kernels[d].zx, g.zx);
        }
      }
    }
  }

  // Sums over the nodes for some rows of the grid.
  void add_distances(const Nodes& nodes, const std::vector<Kernels>& kernels, Index row, Index rows,
                     Index column, Index columns) {
    const double nearest = std::max(grid_.nodes()(row), request_.smallest);
    const double end = nodes.K1 + cut_phase / nearest;
    const Index count = std::lower_bound(nodes.k.begin(), nodes.k.end(), end) - nodes.k.begin();
    const auto k = Eigen::Map<const Eigen::VectorXd>(nodes.k.data(), count);
    // Columns are distances.
    Eigen::MatrixXd J0 = Eigen::MatrixXd::Zero(count, rows), J1 = J0, J2;
    if (request_.horizontal) J2 = J0;
    for (Index i = 0; i < rows; ++i) {
      const double r = grid_.nodes()(row + i), width = cut_phase / std::max(r, request_.smallest);
      const Index reached = std::lower_bound(k.begin(), k.end(), nodes.K1 + width) - k.begin();
      const Eigen::VectorXd x = r * k.head(reached);
      update_bessel(x, J0.col(i).head(reached), J1.col(i).head(reached));
      for (Index n = 0; request_.horizontal && n < reached; ++n)
        J2(n, i) = x(n) > 1e-3 ? 2 * J1(n, i) / x(n) - J0(n, i) : x(n) * x(n) / 8;
      for (Index n = std::upper_bound(k.begin(), k.end(), nodes.K1) - k.begin(); n < reached; ++n) {
        const double cut = compute_cut(k(n), nodes.K1, width);
        J0(n, i) *= cut;
        J1(n, i) *= cut;
        if (request_.horizontal) J2(n, i) *= cut;
      }
    }
    for (std::size_t d = 0; d < kernels.size(); ++d) {
      RadialResponse& out = responses_[d];
      const Kernels& in = kernels[d];
      if (request_.vertical) {
        out.zz.block(row, column, rows, columns).noalias() = J0.transpose() * in.zz.topRows(count);
        out.xz.block(row, column, rows, columns).noalias() = J1.transpose() * in.xz.topRows(count);
      }
      if (request_.horizontal) {
        out.sum.block(row, column, rows, columns).noalias() = J0.transpose() * in.sum.topRows(count);
        out.difference.block(row, column, rows, columns).noalias() =
            J2.transpose() * in.difference.topRows(count);
        out.zx.block(row, column, rows, columns).noalias() = J1.transpose() * in.zx.topRows(count);
      }
    }
  }

  const LayeredGround& ground_;
  const RadialRequest& request_;
  const RadialGrid& grid_;
  const Eigen::VectorXcd& w_;
  int threads_ = 1;
  std::vector<RadialResponse> responses_;
};

}  // namespace

RadialGrid::RadialGrid(double smallest, double largest, double largest_wavenumber) {
  assert(smallest > 0 && largest > smallest);
  const double longest =
      largest_wavenumber > 0 ? 15 / largest_wavenumber : largest;  // 20 points to 15 rad: 3e-7
  edges_ = {0};
  while (edges_.back() < largest) {
    const double r = edges_.back();
    edges_.push_back(r + std::min(std::max(r, smallest), longest));
  }
  const auto panels = static_cast<Index>(edges_.size()) - 1;
  nodes_.resize(panels * points_per_panel);
  for (Index p = 0; p < panels; ++p) {
    const double a = edges_[static_cast<std::size_t>(p)], b = edges_[static_cast<std::size_t>(p) + 1];
    for (int i = 0; i < points_per_panel; ++i) {
      nodes_(p * points_per_panel + i) =
          (a + b) / 2 - (b - a) / 2 * std::cos(pi * (i + 0.5) / points_per_panel);
    }
  }
}

RadialGrid::Weights RadialGrid::compute_weights(double r) const {
  const auto panel = std::clamp<Index>(std::upper_bound(edges_.begin(), edges_.end(), r) - edges_.begin() - 1,
                                       0, static_cast<Index>(edges_.size()) - 2);
  assert(r >= 0 && r <= edges_.back() * (1 + 1e-12));
  Weights weights{panel * points_per_panel, {}};
  // Barycentric formula for Chebyshev points of the first kind.
  static const auto factors = [] {
    Eigen::Matrix<double, points_per_panel, 1> f;
    for (int i = 0; i < points_per_panel; ++i)
      f(i) = (i % 2 ? -1 : 1) * std::sin(pi * (i + 0.5) / points_per_panel);
    return f;
  }();
  const auto distance = (r - nodes_.segment<points_per_panel>(weights.first).array()).eval();
  for (int i = 0; i < points_per_panel; ++i) {
    if (distance(i) == 0) {
      weights.values.setZero();
      weights.values(i) = 1;
      return weights;
    }
  }
  weights.values = factors.array() / distance;
  weights.values /= weights.values.sum();
  return weights;
}

std::vector<RadialResponse> compute_radial_responses(const LayeredGround& ground,
                                                     const RadialRequest& request, const RadialGrid& grid,
                                                     const Eigen::VectorXcd& w) {
  return Synthesis(ground, request, grid, w).run();
}

}  // namespace easydyn::soil

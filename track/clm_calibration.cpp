#include "track/clm_calibration.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <array>
#include <cmath>
#include <complex>
#include <limits>
#include <utility>

#include "easydyn/math/units.hpp"
#include "easydyn/require.hpp"
#include "track/clm_chain.hpp"

namespace easydyn::track {
namespace {

using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;
using Eigen::VectorXcd;
using Eigen::VectorXd;
using Complex = std::complex<double>;
using Vector5 = Eigen::Matrix<double, 5, 1>;
using Matrix5 = Eigen::Matrix<double, 5, 5>;

/// Compliances and their derivatives in A and B, one column per entry that is fitted.
struct Response {
  VectorXcd H, dA, dB;
};

/// Chain of foundations with stiffnesses A (in phase) and B (in opposition).
class Chain {
 public:
  /// @param foundations  0: infinite
  explicit Chain(int foundations) : n_(foundations) {
    if (n_ == 0) {
      entries_ = {{0, 0}, {0, 1}};
      return;
    }
    shapes_.resize(n_, n_);  // phi_k(j), of the chain with free ends
    opposition_.resize(n_);
    for (int k = 0; k < n_; ++k) {
      const double t = k * units::pi / n_;
      opposition_[k] = std::pow(std::sin(t / 2), 2);
      for (int j = 0; j < n_; ++j)
        shapes_(j, k) = std::sqrt((k == 0 ? 1.0 : 2.0) / n_) * std::cos(t * (j + 0.5));
    }
    for (int j = 0; j < n_; ++j) entries_.push_back({j, j});
    for (int j = 0; j + 1 < n_; ++j) entries_.push_back({j, j + 1});
  }

  const std::vector<std::pair<int, int>>& entries() const { return entries_; }

  Response respond(Complex A, Complex B) const {
    const auto count = static_cast<Index>(entries_.size());
    Response r{VectorXcd::Zero(count), VectorXcd::Zero(count), VectorXcd::Zero(count)};
    if (n_ == 0) {
      // Im A, Im B >= 0: the principal roots lie in the first quadrant, so that |L| < 1.
      const Complex p = std::sqrt(A), q = std::sqrt(B), sum = p + q, L = (q - p) / sum;
      const Complex H = 1.0 / (p * q), dH_dA = -0.5 * H / A, dH_dB = -0.5 * H / B;
      const Complex dL_dA = -q / (sum * sum * p), dL_dB = p / (sum * sum * q);
      r.H << H, H * L;
      r.dA << dH_dA, dH_dA * L + H * dL_dA;
      r.dB << dH_dB, dH_dB * L + H * dL_dB;
      return r;
    }
    for (int k = 0; k < n_; ++k) {
      const double s = opposition_[k];
      const Complex inverse = 1.0 / (A * (1 - s) + B * s);
      for (Index e = 0; e < count; ++e) {
        const auto [i, j] = entries_[static_cast<std::size_t>(e)];
        const Complex H = shapes_(i, k) * shapes_(j, k) * inverse;
        r.H[e] += H;
        r.dA[e] -= (1 - s) * inverse * H;
        r.dB[e] -= s * inverse * H;
      }
    }
    return r;
  }

 private:
  int n_;
  MatrixXd shapes_;
  VectorXd opposition_;
  std::vector<std::pair<int, int>> entries_;
};

/// Least squares in x = (a, b, c, e, m) of a scaled problem: stiffness unit 1 / |G_00|, time unit 1 / w.
class Problem {
 public:
  Problem(const VectorXd& omega, const MatrixXcd& target, const VectorXd& weight, const Chain& chain)
      : omega_(omega), target_(target), weight_(weight.cwiseSqrt()), chain_(chain) {}

  /// @returns half the sum of squares; gradient and Gauss's approximation of the second derivatives
  double evaluate(const Vector5& x, Vector5& gradient, Matrix5& second) const {
    double cost = 0;
    gradient.setZero();
    second.setZero();
    for (Index i = 0; i < omega_.size(); ++i) {
      const double w = omega_[i];
      const Complex A(x[0] - w * w * x[4], w * x[2]), B(x[1] - w * w * x[4], w * x[3]);
      const Response r = chain_.respond(A, B);
      for (Index e = 0; e < r.H.size(); ++e) {
        const Complex error = weight_[i] * (r.H[e] - target_(i, e));
        const Complex dA = weight_[i] * r.dA[e], dB = weight_[i] * r.dB[e], iw(0, w);
        Eigen::Matrix<Complex, 5, 1> J;
        J << dA, dB, iw * dA, iw * dB, -w * w * (dA + dB);
        cost += 0.5 * std::norm(error);
        gradient += (J.conjugate() * error).real();
        second += (J.conjugate() * J.transpose()).real();
      }
    }
    return cost;
  }

 private:
  const VectorXd& omega_;
  const MatrixXcd& target_;
  VectorXd weight_;
  const Chain& chain_;
};

struct Minimum {
  Vector5 x = Vector5::Zero();
  double cost = std::numeric_limits<double>::infinity();
  bool has_converged = false;
};

/// Levenberg and Marquardt's method under x >= 0: a variable at its bound whose gradient pushes outward is held there.
Minimum minimise(const Problem& problem, Vector5 x) {
  Vector5 gradient, trial_gradient;
  Matrix5 second, trial_second;
  double cost = problem.evaluate(x, gradient, second), damping = 1e-3;
  for (int iteration = 0; iteration < 2000; ++iteration) {
    std::vector<int> free;
    for (int i = 0; i < 5; ++i)
      if (x[i] > 0 || gradient[i] < 0) free.push_back(i);
    // Stationary: what a step of each free variable by its own scale could gain.
    const Vector5 scale = second.diagonal().cwiseSqrt();
    double slope = 0;
    for (const int i : free)
      if (scale[i] > 0) slope = std::max(slope, std::abs(gradient[i]) / scale[i]);
    if (slope * slope < 1e-22 * cost || cost < 1e-26) return {x, cost, true};

    Vector5 trial = x;
    if (!free.empty()) {
      MatrixXd S = second(free, free);
      S.diagonal() *= 1 + damping;
      trial(free) -= S.ldlt().solve(gradient(free));
      trial = trial.cwiseMax(0.0);
    }
    const double trial_cost = problem.evaluate(trial, trial_gradient, trial_second);
    if (std::isfinite(trial_cost) && trial_cost < cost) {
      x = trial;
      cost = trial_cost;
      gradient = trial_gradient;
      second = trial_second;
      damping = std::max(1e-12, damping / 5);
    } else {
      damping *= 4;
      if (damping > 1e16) return {x, cost, slope * slope < 1e-12 * cost};  // rounding ends the descent
    }
  }
  return {x, cost, false};
}

void validate(const GroundCompliance& ground, const ClmFitOptions& options) {
  const std::string_view object = "calibration of the CLM";
  const Index nf = ground.frequency.size();
  require(nf >= 3, object, "number of frequencies", static_cast<double>(nf), "", ">= 3");
  require(ground.H.rows() == nf, object, "rows of H", static_cast<double>(ground.H.rows()), "",
          fmt::format("{}, one per frequency", nf));
  const int columns = std::max(2, options.foundations);
  require(ground.H.cols() >= columns, object, "columns of H", static_cast<double>(ground.H.cols()), "",
          fmt::format(">= {}", columns));
  require_positive(object, "spacing", ground.spacing, "m");
  for (Index i = 0; i < nf; ++i) {
    require(ground.frequency[i] > (i == 0 ? 0 : ground.frequency[i - 1]), object, "frequency",
            ground.frequency[i], "Hz", "> 0 and ascending");
    require(ground.H.row(i).allFinite(), object, "compliance at a frequency of", ground.frequency[i], "Hz",
            "finite");
    // A passive ground takes energy up.
    require(ground.H(i, 0).imag() <= 0 && std::abs(ground.H(i, 1)) < std::abs(ground.H(i, 0)), object,
            "compliance H_00 at a frequency of", ground.frequency[i], "Hz",
            "with an imaginary part <= 0 (time factor exp(i w t)) and larger than H_01");
  }
  require(options.lowest > 0 && options.highest > options.lowest, object, "highest frequency",
          options.highest, "Hz", fmt::format("> {:g}, the lowest, which is > 0", options.lowest));
  require(options.foundations == 0 || options.foundations >= 2, object, "number of foundations",
          options.foundations, "", "0 (infinitely many) or >= 2");
  require(options.weight.size() == 0 || options.weight.size() == nf, object, "number of weights",
          static_cast<double>(options.weight.size()), "", fmt::format("0 or {}", nf));
  for (const double weight : options.weight) require_not_negative(object, "weight", weight, "");
}

/// Largest share of the ground's stiffness matrix outside its three diagonals.
double compute_left_out(const MatrixXcd& H, int n) {
  double largest = 0;
  for (const auto& row : H.rowwise()) {
    MatrixXcd C(n, n);
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) C(i, j) = row[std::abs(i - j)];
    const MatrixXcd S = C.partialPivLu().inverse();
    MatrixXcd rest = S;
    for (int i = 0; i < n; ++i)
      for (int j = std::max(0, i - 1); j <= std::min(n - 1, i + 1); ++j) rest(i, j) = 0;
    largest = std::max(largest, rest.norm() / S.norm());
  }
  return largest;
}

}  // namespace

ClmFit calibrate_clm(const GroundCompliance& ground, const ClmFitOptions& options) {
  validate(ground, options);
  std::vector<Index> band;
  for (Index i = 0; i < ground.frequency.size(); ++i)
    if (ground.frequency[i] >= options.lowest && ground.frequency[i] <= options.highest) band.push_back(i);
  require(band.size() >= 3, "calibration of the CLM", "frequencies within the band",
          static_cast<double>(band.size()), "", ">= 3, for five constants");

  const Chain chain(options.foundations);
  const auto entries = static_cast<Index>(chain.entries().size()), nf = static_cast<Index>(band.size());
  const MatrixXcd H = ground.H(band, Eigen::all);
  ClmFit fit;
  fit.frequency = ground.frequency(band);

  // Scaled: stiffness unit, time unit.
  const double unit = 1 / std::abs(H(0, 0)), omega_unit = 2 * units::pi * fit.frequency.mean();
  const VectorXd omega = 2 * units::pi / omega_unit * fit.frequency;
  MatrixXcd target(nf, entries);
  for (Index e = 0; e < entries; ++e) {
    const auto [i, j] = chain.entries()[static_cast<std::size_t>(e)];
    target.col(e) = unit * H.col(std::abs(i - j));
  }
  const VectorXd weight =
      options.weight.size() == 0 ? VectorXd(VectorXd::Ones(nf)) : VectorXd(options.weight(band));
  require(weight.maxCoeff() > 0, "calibration of the CLM", "largest weight within the band",
          weight.maxCoeff(), "", "> 0");
  const Problem problem(omega, target, weight, chain);

  // Starts: stiffness from the lowest frequency, dampings and masses over a decade around one unit.
  const ChainStiffness low = invert_infinite_chain(unit * H(0, 0), unit * H(0, 1));
  const double a = std::max(0.05, low.K_f.real()), b = std::max(a, (low.K_f + 4.0 * low.K_c).real());
  Minimum best;
  for (const double c : {0.1, 0.5, 2.0})
    for (const double e : {0.1, 0.5, 2.0})
      for (const double m : {0.02, 0.3}) {
        Vector5 start;
        start << a, b, c, e, m;
        const Minimum found = minimise(problem, start);
        if (found.has_converged && found.cost < best.cost) best = found;
      }
  if (!best.has_converged)
    throw SolverError(fmt::format("calibration of the CLM: no fit over {:g} to {:g} Hz; try a narrower band",
                                  options.lowest, options.highest));

  // Results, in units.
  const auto& x = best.x;
  const double k_f = unit * x[0], d_f = unit / omega_unit * x[2];
  double k_c = unit * (x[1] - x[0]) / 4, d_c = unit / omega_unit * (x[3] - x[2]) / 4;
  while (k_f + 4 * k_c < 0) k_c = std::nextafter(k_c, 0.0);  // rounded toward passivity
  while (d_f + 4 * d_c < 0) d_c = std::nextafter(d_c, 0.0);
  const double m_f = unit / (omega_unit * omega_unit) * x[4];
  const std::array<const char*, 5> bound_names = {"k_f = 0", "k_f + 4 k_c = 0", "d_f = 0", "d_f + 4 d_c = 0",
                                                  "m_f = 0"};
  for (int i = 0; i < 5; ++i)
    if (x[i] == 0) fit.bounds.emplace_back(bound_names[static_cast<std::size_t>(i)]);
  fit.stiffness_margin = x[0] > 0 ? x[1] / x[0] : 0;
  fit.damping_margin = x[2] > 0 ? x[3] / x[2] : 0;
  const int n = options.foundations;
  fit.system = n == 0 ? "infinite chain" : fmt::format("chain of {}", n);
  if (n > 2) fit.left_out = compute_left_out(H, n);

  fit.ground_00 = H.col(0);
  fit.ground_01 = H.col(1);
  fit.model_00.resize(nf);
  fit.model_01.resize(nf);
  const Index middle = n == 0 ? 0 : (n - 1) / 2, beside = n == 0 ? 1 : n + std::min<Index>(middle, n - 2);
  double squares_00 = 0, squares_01 = 0;
  for (Index i = 0; i < nf; ++i) {
    const double w = omega[i];
    const Response r = chain.respond({x[0] - w * w * x[4], w * x[2]}, {x[1] - w * w * x[4], w * x[3]});
    fit.model_00[i] = r.H[middle] / unit;
    fit.model_01[i] = r.H[beside] / unit;
    const Index own = n == 0 ? 1 : n;  // entries (i, i), then the neighbours'
    squares_00 += (r.H.head(own) - target.row(i).head(own).transpose()).squaredNorm() / double(own);
    squares_01 += (r.H.tail(entries - own) - target.row(i).tail(entries - own).transpose()).squaredNorm() /
                  double(entries - own);
  }
  fit.rms_00 = std::sqrt(squares_00 / double(nf));
  fit.rms_01 = std::sqrt(squares_01 / double(nf));
  const std::string source = fmt::format(
      "C: fit to {}, {}, {:g}-{:g} Hz, rms error {:.0f} % of H_00 and {:.0f} % of H_01 (of H_00 at the "
      "lowest frequency)",
      ground.source, fit.system, fit.frequency[0], fit.frequency[nf - 1], 100 * fit.rms_00, 100 * fit.rms_01);
  fit.clm = {{m_f, source}, {k_f, source}, {d_f, source}, {k_c, source}, {d_c, source}};
  validate(Foundation(fit.clm), "calibrated CLM");
  return fit;
}

}  // namespace easydyn::track

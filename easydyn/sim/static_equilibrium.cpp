#include "easydyn/sim/static_equilibrium.hpp"

#include <fmt/format.h>
#include <kinsol/kinsol.h>
#include <nvector/nvector_serial.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <exception>
#include <sundials/sundials_context.hpp>

#include "easydyn/error.hpp"
#include "easydyn/sim/condensation.hpp"

namespace easydyn {

using Eigen::VectorXd;

namespace {

// The condensed static problem: z = (bodies' coordinates, first-order states, port forces).
class StaticProblem {
 public:
  StaticProblem(System& system, const State& guess)
      : system_(system),
        state_(guess),
        n_(system.body_size()),
        n_first_(system.first_order_size()),
        condensation_(system, 0, 0, 1) {
    if (system.constraint_size() > 0)
      throw ModelError(
          fmt::format("static equilibrium: system \"{}\" has velocity constraints, which hold any position: "
                      "lock coordinates instead",
                      system.name()));
    const int n_structures = static_cast<int>(guess.q.size()) - n_;
    system_.evaluate(state_);
    n_ports_ = static_cast<int>(system_.ports().size());

    // Structures carry the given inertia and damping forces; rates at the ports are the given ones.
    VectorXd b(n_structures);
    int at = 0;
    for (const auto& s : system_.structures()) {
      b.segment(at, s->size()) =
          -(s->M() * guess.qdd.segment(n_ + at, s->size()) + s->C() * guess.qd.segment(n_ + at, s->size()));
      at += s->size();
    }
    condensation_.solve(b, system_.ports());
    condensation_.set_bases(VectorXd::Zero(n_structures), 1, guess.qd.tail(n_structures), 0);
  }

  int size() const { return n_ + n_first_ + n_ports_; }
  int port_count() const { return n_ports_; }

  // The guess, with port forces that hold the structures where the guess has them: bodies and structures then
  // start in touch, however far the solution is.
  VectorXd initial() {
    system_.evaluate(state_);
    const std::vector<System::PortRecord> ports = system_.ports();
    VectorXd z(size()), wanted(n_ports_);
    z.head(n_) = state_.q.head(n_);
    z.segment(n_, n_first_) = state_.x;
    Eigen::MatrixXd compliance(n_ports_, n_ports_);
    const auto displacement = [&](int p, const VectorXd& F) {
      const System::PortRecord& port = ports[static_cast<std::size_t>(p)];
      return condensation_.motion(port.structure, port.shape, F).displacement;
    };
    const VectorXd none = VectorXd::Zero(n_ports_);
    for (int p = 0; p < n_ports_; ++p) {
      wanted[p] = ports[static_cast<std::size_t>(p)].motion.displacement - displacement(p, none);
      for (int l = 0; l < n_ports_; ++l)
        compliance(p, l) = displacement(p, VectorXd::Unit(n_ports_, l)) - displacement(p, none);
    }
    if (n_ports_ > 0) z.tail(n_ports_) = compliance.fullPivLu().solve(wanted);
    return z;
  }

  void residual(const VectorXd& z, VectorXd& r) {
    const VectorXd F = z.tail(n_ports_);
    System::BodyState at = System::body_state(state_);
    at.q = z.data();
    at.x = z.data() + n_;
    system_.compute_body_residual(
        at, [&](int k, const PortShape& shape) { return condensation_.motion(k, shape, F); }, r.data());
    system_.update_loops(state_);
    for (int p = 0; p < n_ports_; ++p)
      r[n_ + n_first_ + p] = F[p] - system_.ports()[static_cast<std::size_t>(p)].force;
  }

  State solution(const VectorXd& z) {
    State s = state_;
    s.q.head(n_) = z.head(n_);
    s.x = z.segment(n_, n_first_);
    condensation_.compute_response(z.tail(n_ports_), s.q.tail(s.q.size() - n_));
    return s;
  }

  /// Measure of the coordinates for damping: their masses; 1 for first-order states, 0 for port forces.
  VectorXd inertia() {
    VectorXd D = VectorXd::Zero(size());
    Eigen::MatrixXd M(n_, n_);
    VectorXd bias(n_);
    system_.compute_mass_and_bias(state_, M, bias);
    D.head(n_) = M.diagonal();
    D.segment(n_, n_first_).setOnes();
    return D;
  }

  /// Whether the last evaluation touched the structures elsewhere than where they were condensed.
  bool ports_moved() const { return condensation_.ports_moved(system_.ports()); }

  std::string name(int i) const {
    if (i < n_) return "coordinate \"" + system_.coordinate_name(i) + "\"";
    if (i < n_ + n_first_) return "first-order state \"" + system_.equation_name(i) + "\"";
    return fmt::format("port force {}", i - n_ - n_first_);
  }

  int coordinate_count() const { return n_; }
  bool has_coordinates_only() const { return n_first_ == 0 && n_ports_ == 0; }

  std::exception_ptr thrown;  // by the user's program, inside KINSOL

 private:
  System& system_;
  State state_;
  int n_, n_first_, n_ports_ = 0;
  Condensation condensation_;
};

int kinsol_residual(N_Vector z, N_Vector r, void* data) {
  auto& problem = *static_cast<StaticProblem*>(data);
  const VectorXd z_copy = Eigen::Map<VectorXd>(N_VGetArrayPointer(z), problem.size());
  VectorXd value(problem.size());
  try {
    problem.residual(z_copy, value);
  } catch (const SolverError&) {  // a trial beyond what the system can do: a shorter step may pass
    return 1;
  } catch (...) {
    problem.thrown = std::current_exception();
    return -1;
  }
  Eigen::Map<VectorXd>(N_VGetArrayPointer(r), problem.size()) = value;
  return value.allFinite() ? 0 : 1;
}

void ignore_message(int, const char*, const char*, char*, void*) {}  // flags are turned into SolverError

// KINSOL's objects, freed in the right order.
struct Kinsol {
  sundials::Context context;
  N_Vector z = nullptr, z_scale = nullptr, r_scale = nullptr;
  SUNMatrix matrix = nullptr;
  SUNLinearSolver linear = nullptr;
  void* memory = nullptr;
  ~Kinsol() {
    KINFree(&memory);
    SUNLinSolFree(linear);
    SUNMatDestroy(matrix);
    N_VDestroy(z);
    N_VDestroy(z_scale);
    N_VDestroy(r_scale);
  }
};

Eigen::MatrixXd difference_jacobian(StaticProblem& problem, const VectorXd& z) {
  const int n = problem.size();
  Eigen::MatrixXd J(n, n);
  VectorXd shifted = z, r(n), r_shifted(n);
  problem.residual(z, r);
  for (int i = 0; i < n; ++i) {
    shifted[i] = z[i] + 1e-7 * std::max(std::abs(z[i]), 1e-2);
    problem.residual(shifted, r_shifted);
    J.col(i) = (r_shifted - r) / (shifted[i] - z[i]);
    shifted[i] = z[i];
  }
  return J;
}

// Says which coordinate is the trouble: the one that moves without stiffness, else the one least in balance.
[[noreturn]] void throw_unsettled(StaticProblem& problem, const VectorXd& z, const std::string& why) {
  VectorXd r(problem.size());
  problem.residual(z, r);
  const Eigen::FullPivLU<Eigen::MatrixXd> lu(difference_jacobian(problem, z));
  Eigen::Index worst = 0;
  if (!lu.isInvertible()) {
    lu.kernel().col(0).cwiseAbs().maxCoeff(&worst);
    throw SolverError(
        fmt::format("static equilibrium: {}; nothing holds {} (no stiffness at value {:.6g}, "
                    "residual {:.3g} N or N m): add a spring or lock it",
                    why, problem.name(static_cast<int>(worst)), z[worst], r[worst]));
  }
  const double largest = r.cwiseAbs().maxCoeff(&worst);
  throw SolverError(
      fmt::format("static equilibrium: {}; largest residual {:.3g} N or N m at {}, value {:.6g}; "
                  "is the first guess near?",
                  why, largest, problem.name(static_cast<int>(worst)), z[worst]));
}

// Empty, or why KINSOL stopped.
std::string solve_with_kinsol(StaticProblem& problem, VectorXd& z, double reference,
                              const StaticOptions& options) {
  Kinsol k;
  const int n = problem.size();
  k.z = N_VMake_Serial(n, z.data(), k.context);
  k.z_scale = N_VNew_Serial(n, k.context);
  k.r_scale = N_VNew_Serial(n, k.context);
  // Coordinates count in m or rad, port forces against the reference force.
  Eigen::Map<VectorXd> z_scale(N_VGetArrayPointer(k.z_scale), n);
  z_scale.setOnes();
  z_scale.tail(problem.port_count()).setConstant(1 / reference);
  N_VConst(1 / reference, k.r_scale);
  k.matrix = SUNDenseMatrix(n, n, k.context);
  k.linear = SUNLinSol_Dense(k.z, k.matrix, k.context);
  k.memory = KINCreate(k.context);
  KINSetErrHandlerFn(k.memory, ignore_message, nullptr);
  KINInit(k.memory, kinsol_residual, k.z);
  KINSetUserData(k.memory, &problem);
  KINSetLinearSolver(k.memory, k.linear, k.matrix);
  KINSetNumMaxIters(k.memory, options.max_iterations);
  KINSetFuncNormTol(k.memory, options.tolerance);
  KINSetScaledStepTol(k.memory, 1e-15);
  // Turns and shifts of the order of 1: a longer step ends anywhere (the default refuses to leave a guess at zero).
  KINSetMaxNewtonStep(k.memory, std::sqrt(double(n)));
  KINSetMaxSetupCalls(k.memory, 1);
  const int flag = KINSol(k.memory, k.z, KIN_LINESEARCH, k.z_scale, k.r_scale);
  if (problem.thrown) std::rethrow_exception(problem.thrown);
  if (flag < 0 && flag != KIN_LINESEARCH_NONCONV) {
    char* flag_name = KINGetReturnFlagName(flag);
    const std::string why = std::string("KINSOL stopped with ") + flag_name;
    free(flag_name);
    return why;
  }
  return "";
}

// The way of a heavily damped system to where its forces bring it, mu D z. = -r(z), by implicit steps that grow as the
// residual falls (pseudo-transient continuation: Kelley & Keyes, SIAM J. Numer. Anal. 35, 1998). Slower than Newton, but
// from far away, and never to an equilibrium that it would leave.
bool relax(StaticProblem& problem, VectorXd& z, double reference, const StaticOptions& options) {
  constexpr double first_move = 0.05, largest_move = 0.5;  // [m, rad]
  const int n = problem.size();
  const VectorXd D = problem.inertia();
  VectorXd r(n), moved, r_moved(n);
  problem.residual(z, r);
  double mu = 0;
  for (int i = 0; i < n; ++i)
    if (D[i] > 0) mu = std::max(mu, std::abs(r[i]) / (first_move * D[i]));
  for (int iteration = 0; iteration < 10 * options.max_iterations; ++iteration) {
    if (r.lpNorm<Eigen::Infinity>() <= options.tolerance * reference) return true;
    const Eigen::MatrixXd J = difference_jacobian(problem, z);
    // An implicit step that is too long would be drawn to where the system falls away from.
    Eigen::MatrixXd A = J;
    A.diagonal() += mu * D;
    const Eigen::LLT<Eigen::MatrixXd> symmetric(0.5 * (A + A.transpose()));
    const bool is_short_enough = !problem.has_coordinates_only() || symmetric.info() == Eigen::Success;
    moved = z - A.partialPivLu().solve(r);
    const bool is_near = moved.allFinite() &&
                         ((moved - z).head(problem.coordinate_count()).array().abs() <= largest_move).all();
    if (is_short_enough && is_near) problem.residual(moved, r_moved);
    if (!is_short_enough || !is_near || !r_moved.allFinite()) {
      mu = std::max(4 * mu, 1e-12);
      continue;
    }
    const double ratio = r_moved.norm() / std::max(r.norm(), 1e-300);
    mu *= std::clamp(ratio, 0.2, 2.0);
    z = moved;
    r = r_moved;
  }
  return false;
}

// Undamped Newton with a difference Jacobian, while it helps. Empty, or why it is not at rest.
std::string polish(StaticProblem& problem, VectorXd& z, double reference, const StaticOptions& options) {
  const int n = problem.size();
  VectorXd r(n), shifted, r_shifted(n);
  problem.residual(z, r);
  bool is_rounding = false;  // of the unknowns: what is left of the forces comes from their last digits
  for (int iteration = 0; iteration < 10; ++iteration) {
    const Eigen::FullPivLU<Eigen::MatrixXd> lu(difference_jacobian(problem, z));
    if (!lu.isInvertible()) return "the stiffness matrix is singular";
    const VectorXd correction = lu.solve(r);
    is_rounding = (correction.array().abs() <= 1e-14 * (1 + z.array().abs())).all();
    shifted = z - correction;
    problem.residual(shifted, r_shifted);
    const bool better = r_shifted.lpNorm<Eigen::Infinity>() < 0.5 * r.lpNorm<Eigen::Infinity>();
    if (r_shifted.lpNorm<Eigen::Infinity>() < r.lpNorm<Eigen::Infinity>()) {
      z = shifted;
      r = r_shifted;
    }
    if (!better) break;
  }
  return is_rounding || r.lpNorm<Eigen::Infinity>() <= options.tolerance * reference
             ? ""
             : "the iteration does not settle";
}

// Whether the stiffness resists every small motion; where ports or first-order states take part that is not asked.
bool is_stable(StaticProblem& problem, const VectorXd& z) {
  if (!problem.has_coordinates_only()) return true;
  const Eigen::MatrixXd J = difference_jacobian(problem, z);
  const VectorXd stiffness =
      Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(0.5 * (J + J.transpose()), Eigen::EigenvaluesOnly)
          .eigenvalues();
  return stiffness[0] >= -1e-6 * stiffness.cwiseAbs().maxCoeff();
}

// Newton, and where it does not get through, or to an equilibrium that would not hold, the way of heavy damping.
void settle(StaticProblem& problem, VectorXd& z, double reference, const StaticOptions& options) {
  const VectorXd start = z;
  std::string why = solve_with_kinsol(problem, z, reference, options);
  if (why.empty()) why = polish(problem, z, reference, options);
  const VectorXd reached = z;
  if (why.empty()) {
    if (!options.damping || is_stable(problem, z)) return;
    z = start;
    if (!relax(problem, z, reference, options) || !polish(problem, z, reference, options).empty())
      z = reached;
    return;
  }
  z = start;
  if (!options.damping || !relax(problem, z, reference, options) ||
      !polish(problem, z, reference, options).empty())
    throw_unsettled(problem, reached, why);
}

}  // namespace

State solve_static_equilibrium(System& system, const State& guess, const StaticOptions& options) {
  State state = guess;
  constexpr int most_passes = 50;
  for (int pass = 0; pass < most_passes; ++pass) {
    StaticProblem problem(system, state);
    VectorXd z = problem.initial(), r(problem.size());
    if (problem.size() == 0) return problem.solution(z);

    // Forces are measured against the largest one that acts at the guess.
    problem.residual(z, r);
    const double reference = std::max(r.lpNorm<Eigen::Infinity>(), 1.0);
    if (pass == 0) {
      settle(problem, z, reference, options);
    } else if (const std::string why = polish(problem, z, reference, options); !why.empty()) {
      throw_unsettled(problem, z, why);
    }
    state = problem.solution(z);

    // A port whose place depends on the coordinates has moved: condense again there.
    if (!problem.ports_moved()) return state;
  }
  throw SolverError(
      fmt::format("static equilibrium: the places where system \"{}\" touches its structures do not "
                  "settle in {} passes; is the first guess near?",
                  system.name(), most_passes));
}

State solve_static_equilibrium(System& system, const StaticOptions& options) {
  return solve_static_equilibrium(system, system.initial_state(), options);
}

State solve_quasi_static_motion(System& system, const State& guess, double dt, const StaticOptions& options) {
  if (!(dt > 0)) throw ModelError(fmt::format("quasi-static motion: dt = {} s, must be > 0", dt));
  State at_rest = guess;
  at_rest.qd.setZero();
  at_rest.qdd.setZero();

  // Equilibria around the instant: fourth-order central differences give rates and accelerations.
  std::array<VectorXd, 5> q;
  State shifted = at_rest;
  for (int k = 0; k < 5; ++k) {
    shifted.t = guess.t + (k - 2) * dt;
    shifted = solve_static_equilibrium(system, shifted, options);
    q[static_cast<std::size_t>(k)] = shifted.q;
  }
  State start = at_rest;
  start.q = q[2];
  start.qd = (q[0] - 8 * q[1] + 8 * q[3] - q[4]) / (12 * dt);
  start.qdd = (-q[0] + 16 * q[1] - 30 * q[2] + 16 * q[3] - q[4]) / (12 * dt * dt);
  start.qd.head(system.body_size()).setZero();
  start.qdd.head(system.body_size()).setZero();
  return solve_static_equilibrium(system, start, options);
}

}  // namespace easydyn

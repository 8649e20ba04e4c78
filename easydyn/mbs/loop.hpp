#pragma once

#include <Eigen/Core>
#include <Eigen/QR>
#include <array>
#include <memory>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "easydyn/math/expr.hpp"
#include "easydyn/math/expr_vector.hpp"

namespace easydyn {

/// What all loops share: Newton's iteration and the implicit function theorem. See Loop.
class LoopClosure {
 public:
  /// @param first  index of the first unknown in gradients, beyond all coordinates
  LoopClosure(std::string system, std::string name, std::span<const double> guess, int first);

  /// Where the solution for the initial state starts: which branch.
  void set_guess(std::span<const double> guess);
  /// Entries in State::loops: the unknowns and the sign of the branch.
  int memory_size() const { return n_ + 1; }
  void write_guess(double* memory) const;   ///< of the initial state
  void write_memory(double* memory) const;  ///< of the last solution
  void read_memory(const double* memory);   ///< the next solution starts from here
  std::span<const double> values() const { return {p_.data(), static_cast<std::size_t>(p_.size())}; }
  const std::string& name() const { return name_; }

 private:
  template <int N>
  friend class Loop;
  void begin(double t);
  Expr unknown(int i) const;
  /// Takes the equations at the present unknowns. True: solved.
  bool take(std::span<const Expr> equations);
  Expr solution(int i) const;

  enum class Phase { newton, line_search, rates };
  void decompose(std::span<const Expr> equations);
  /// x = J^+ right by the decomposition; `right` is used up.
  template <class X>
  void solve_least_squares(Eigen::VectorXd& right, X&& x);
  int compute_orientation() const;
  [[noreturn]] void fail(const std::string& what);

  std::string system_, name_;
  int n_, first_;
  Phase phase_ = Phase::newton;
  int iterations_ = 0, halvings_ = 0;
  int orientation_ = 0;  // sign of det J on the branch; 0: not yet known, or more equations than unknowns
  double t_ = 0;
  double scale_ = 0, last_norm_ = 0;
  Eigen::VectorXd guess_, start_, p_, rate_, bias_, step_, residual_, right_;
  Eigen::MatrixXd jacobian_, inverse_;
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr_;
  std::vector<Gradient> gradients_;
};

/// A closed loop in independent coordinates: N dependent quantities p (angles, displacements) that the
/// equations g(p, q, t) = 0 determine. Solved in positions() at each evaluation; the solution is N expressions.
///
///     Loop<2> closure = loop<2>("four-bar", {0.5, 1.2});            // a guess: which branch
///     void positions() override {
///       const auto [coupler, rocker] = closure.solve([&](const auto& p) {
///         return std::array{a * cos(crank) + b * cos(p[0]) - c * cos(p[1]) - d,
///                           a * sin(crank) + b * sin(p[0]) - c * sin(p[1])};
///       });
///       ...
///
/// Newton's iteration starts from the unknowns that the State carries, those of the last accepted step: the branch is
/// kept by continuity, and a state means the same whatever was evaluated before. Who moves a mechanism by hand, state by
/// state, keeps one `State` and passes it to `System::evaluate`, which writes the solution back. Rates, biases and gradients follow from the implicit
/// function theorem:
///
///   J p. = -g.(p. = 0)      J p.. = -g..(p.. = 0)      J dp/dq = -dg/dq      J = dg/dp
///
/// Branches meet where det J = 0 (a dead point, a flat parallelogram), so that its sign stays the same along a branch. A
/// solution of the other sign is refused: the motion has passed such a point, or Newton has left the branch.
/// `set_guess` chooses anew. Two branches of the same sign cannot be told apart: far jumps of q may change them.
///
/// There may be more equations than unknowns if they agree (J is solved by rank-revealing least squares; no sign is
/// watched then). The equations may use frames: motions made for them do not stay in the system.
/// @throws SolverError naming system and loop: singular (rank of J below N), dead point passed, contradictory
///         equations, no convergence
template <int N>
class Loop {
 public:
  explicit Loop(std::shared_ptr<LoopClosure> closure) : closure_(std::move(closure)) {}

  /// @param equations  called with std::array<Expr, N>; returns a std::array or std::vector of Expr, or an
  ///                   ExprVector
  template <class Equations>
  std::array<Expr, N> solve(const Equations& equations);

  /// Where the solution for the initial state starts.
  void set_guess(const std::array<double, N>& guess) { closure_->set_guess(guess); }
  double value(int i) const { return closure_->values()[static_cast<std::size_t>(i)]; }

 private:
  std::shared_ptr<LoopClosure> closure_;
};

}  // namespace easydyn

#include "easydyn/mbs/motion_tree.hpp"

namespace easydyn {

template <int N>
template <class Equations>
std::array<Expr, N> Loop<N>::solve(const Equations& equations) {
  MotionTree* const tree = MotionTree::current();
  const int motions = tree ? tree->size() : 0;
  const MotionTree::Trial trial(tree);
  closure_->begin(tree ? tree->time() : 0);
  for (bool is_solved = false; !is_solved;) {
    std::array<Expr, N> p;
    for (int i = 0; i < N; ++i) p[static_cast<std::size_t>(i)] = closure_->unknown(i);
    const auto g = equations(static_cast<const std::array<Expr, N>&>(p));
    if constexpr (std::is_same_v<std::remove_cvref_t<decltype(g)>, ExprVector>) {
      is_solved = closure_->take(std::array{g[0], g[1], g[2]});
    } else {
      is_solved = closure_->take(g);
    }
    if (tree) tree->shrink_to(motions);
  }
  std::array<Expr, N> solution;
  for (int i = 0; i < N; ++i) solution[static_cast<std::size_t>(i)] = closure_->solution(i);
  return solution;
}

}  // namespace easydyn

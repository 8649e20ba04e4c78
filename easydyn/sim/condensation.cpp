#include "easydyn/sim/condensation.hpp"

#include <cmath>

namespace easydyn {

using Eigen::VectorXd;

Condensation::Condensation(const System& system, double a_M, double a_C, double a_K) : system_(system) {
  int offset = 0;
  for (const auto& s : system.structures()) {
    const SparseMatrix A = a_M * s->M() + a_C * s->C() + a_K * s->K();
    factors_.emplace_back(A, s->half_bandwidth(), s->name());
    offset_.push_back(offset);
    offset += s->size();
  }
  X_.resize(factors_.size());
  port_of_.resize(factors_.size());
}

void Condensation::solve(const VectorXd& b, const std::vector<System::PortRecord>& ports) {
  shapes_.clear();
  for (const System::PortRecord& port : ports) shapes_.push_back(port.shape);
  for (std::size_t k = 0; k < factors_.size(); ++k) {
    port_of_[k].clear();
    for (std::size_t p = 0; p < ports.size(); ++p)
      if (ports[p].structure == static_cast<int>(k)) port_of_[k].push_back(static_cast<int>(p));

    // Columns: free response, then one unit force per port; padded to a multiple of four.
    const int used = 1 + static_cast<int>(port_of_[k].size());
    RightHandSides& X = X_[k];
    X.setZero(factors_[k].size(), (used + 3) / 4 * 4);
    X.col(0) = b.segment(offset_[k], factors_[k].size());
    for (std::size_t c = 0; c < port_of_[k].size(); ++c) {
      const PortShape& shape = ports[static_cast<std::size_t>(port_of_[k][c])].shape;
      for (std::size_t i = 0; i < static_cast<std::size_t>(shape.count); ++i)
        X(shape.index[i], static_cast<int>(c) + 1) += shape.value[i];
    }
    factors_[k].solve_in_place(X);
  }
}

bool Condensation::ports_moved(const std::vector<System::PortRecord>& ports) const {
  constexpr double rounding = 1e-13;  // of shape functions of order 1
  if (ports.size() != shapes_.size()) return true;
  for (std::size_t p = 0; p < ports.size(); ++p) {
    const PortShape &now = ports[p].shape, &then = shapes_[p];
    if (now.count != then.count) return true;
    for (std::size_t i = 0; i < static_cast<std::size_t>(now.count); ++i)
      if (now.index[i] != then.index[i] || !(std::abs(now.value[i] - then.value[i]) <= rounding)) return true;
  }
  return false;
}

void Condensation::set_bases(const Eigen::Ref<const VectorXd>& q_base, double c_q,
                             const Eigen::Ref<const VectorXd>& qd_base, double c_v) {
  q_base_ = q_base;
  qd_base_ = qd_base;
  c_q_ = c_q;
  c_v_ = c_v;
}

PortMotion Condensation::motion(int structure, const PortShape& shape, const VectorXd& F) const {
  const auto k = static_cast<std::size_t>(structure);
  PortMotion motion;
  for (std::size_t i = 0; i < static_cast<std::size_t>(shape.count); ++i) {
    const int row = shape.index[i];
    double y = X_[k](row, 0);
    for (std::size_t c = 0; c < port_of_[k].size(); ++c)
      y += X_[k](row, static_cast<int>(c) + 1) * F[port_of_[k][c]];
    const double q = q_base_[offset_[k] + row] + c_q_ * y;
    motion.displacement += shape.value[i] * q;
    motion.slope += shape.gradient[i] * q;
    motion.velocity += shape.value[i] * (qd_base_[offset_[k] + row] + c_v_ * y);
  }
  return motion;
}

void Condensation::compute_response(const VectorXd& F, Eigen::Ref<VectorXd> y) {
  for (std::size_t k = 0; k < factors_.size(); ++k) {
    weights_.setZero(X_[k].cols());
    weights_[0] = 1;
    for (std::size_t c = 0; c < port_of_[k].size(); ++c)
      weights_[static_cast<int>(c) + 1] = F[port_of_[k][c]];
    y.segment(offset_[k], factors_[k].size()).noalias() = X_[k] * weights_;
  }
}

}  // namespace easydyn

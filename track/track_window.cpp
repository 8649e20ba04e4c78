#include "track/track_window.hpp"

#include <algorithm>
#include <cmath>

#include "easydyn/require.hpp"

namespace easydyn::track {

using Eigen::VectorXd;

namespace {
constexpr int block_padding = 2;  // makes 12 of the 10 rows of a usual bay: three vectors of four
}

TrackWindow::Product::Product(const SparseMatrix& A, const TrackModel& model, bool is_uniform_)
    : per_bay(model.dofs_per_bay()), bays(model.bays()), is_uniform(is_uniform_ && model.bays() >= 3) {
  begin.push_back(0);
  for (int i = 0; i < A.rows(); ++i) {
    for (SparseMatrix::InnerIterator it(A, i); it; ++it) {
      if (it.value() == 0) continue;
      column.push_back(static_cast<int>(it.col()));
      value.push_back(it.value());
    }
    begin.push_back(static_cast<int>(column.size()));
  }
  if (!is_uniform) return;
  const int start = bays / 2 * per_bay;
  for (int c = 0; c < 3 * per_bay; ++c) {
    VectorXd rows = VectorXd::Zero(per_bay);
    for (int r = 0; r < per_bay; ++r) rows[r] = A.coeff(start + r, start - per_bay + c);
    if (rows.isZero(0)) continue;
    block_columns.push_back(c);
    block.insert(block.end(), rows.begin(), rows.end());
    block.resize(block.size() + block_padding, 0.0);
  }
}

void TrackWindow::Product::subtract_row(int row, const double* x, double& y) const {
  double sum = 0;
  for (int k = begin[static_cast<std::size_t>(row)]; k < begin[static_cast<std::size_t>(row) + 1]; ++k)
    sum += value[static_cast<std::size_t>(k)] * x[column[static_cast<std::size_t>(k)]];
  y -= sum;
}

void TrackWindow::Product::subtract(int offset, int size, int padding, const double* x, double* y) const {
  const double* const x_of_column = x + padding - offset;
  double* const y_of_row = y + padding - offset;
  // The first and the last bay of the track are not like the others; windows begin with a bay.
  const int dense_begin = is_uniform ? std::max(offset, per_bay) : offset + size;
  const int dense_bays = std::max(0, (std::min(offset + size, (bays - 1) * per_bay) - dense_begin) / per_bay);
  for (int row = offset; row < std::min(dense_begin, offset + size); ++row)
    subtract_row(row, x_of_column, y_of_row[row]);
  const std::size_t stride = static_cast<std::size_t>(per_bay) + block_padding;
  for (int bay = 0; bay < dense_bays; ++bay) {
    const int start = dense_begin + bay * per_bay;
    double* const rows = y_of_row + start;
    const double* const around = x_of_column + start - per_bay;
    if (per_bay == 10) {  // four elements per bay on a foundation: a size that the compiler knows
      using Sum = Eigen::Array<double, 10 + block_padding, 1>;
      Sum sum = Sum::Zero();
      for (std::size_t k = 0; k < block_columns.size(); ++k)
        sum += around[block_columns[k]] * Sum::Map(block.data() + k * stride);
      Eigen::Array<double, 10, 1>::Map(rows) -= sum.head<10>();
    } else {
      for (std::size_t k = 0; k < block_columns.size(); ++k)
        VectorXd::Map(rows, per_bay) -=
            around[block_columns[k]] * VectorXd::Map(block.data() + k * stride, per_bay);
    }
  }
  if (!is_uniform) return;
  for (int row = std::max(offset, dense_begin + dense_bays * per_bay); row < offset + size; ++row)
    subtract_row(row, x_of_column, y_of_row[row]);
}

TrackWindow::TrackWindow(const TrackModel& model, int bays, double step)
    : model_(model),
      bays_(bays > 0 && bays + 2 <= model.bays() ? bays : model.bays()),
      per_bay_(model.dofs_per_bay()),
      size_(model.dofs_of(bays_)),
      padding_(2 * model.dofs_per_bay()),
      h_(step),
      M_(model.M()),
      C_(is_whole_track() ? model.C() : model.inner_damping()),
      K_(model.K()),
      end_damping_(size_, size_),
      C_product_(C_, model, model.is_uniform() && !is_whole_track()),
      K_product_(K_, model, model.is_uniform()) {
  require_positive(model.data().label(), "time step", step, "s");
  if (!is_whole_track()) {
    const int ends = model.data().ends.bays;
    require(bays_ >= 2 * ends + 2, model.data().label(), "window", bays_ * model.data().sleeper_spacing, "m",
            fmt::format(">= {:g}, two absorbing ends of {} bays and two bays between them",
                        (2 * ends + 2) * model.data().sleeper_spacing.value, ends));
    end_damping_ = model.compute_end_damping(bays_);
    end_damping_.prune(0.0);
  }
  for (VectorXd* v : {&q_, &qd_, &y_, &rate_before_}) v->setZero(size_ + 2 * padding_);
  first_bay_ = is_whole_track() ? 0 : 1;
  offset_ = first_bay_ * per_bay_;
  factorise();
  choose_reach();
  tables_.resize(static_cast<std::size_t>(bays_) + 1);
}

void TrackWindow::factorise() {
  SparseMatrix A = M_.block(offset_, offset_, size_, size_);
  A += 0.5 * h_ * C_.block(offset_, offset_, size_, size_);
  A += 0.25 * h_ * h_ * K_.block(offset_, offset_, size_, size_);
  A += 0.5 * h_ * end_damping_;
  factor_ = BandedCholesky(A, model_.half_bandwidth(), model_.data().label());
  ++factorisations_;
}

// So far that the columns of the bay in the middle have decayed to rounding, or to the ends of the window.
void TrackWindow::choose_reach() {
  constexpr double rounding = 1e-14;
  const int middle = bays_ / 2, most = std::min(middle, bays_ - middle);
  std::vector<double> x(static_cast<std::size_t>(size_));
  for (reach_ = std::min(6, most); reach_ < most; reach_ += 2) {
    bool has_decayed = true;
    const int first = (middle - reach_) * per_bay_, last = (middle + reach_ + 1) * per_bay_ - 1;
    for (int c = 0; c < per_bay_ && has_decayed; ++c) {
      const int j = middle * per_bay_ + c;
      factor_.solve_unit_in_part(j, std::max(first - per_bay_, 0), std::min(last + per_bay_, size_ - 1),
                                 x.data());
      const auto row = [&](int i) {
        return std::abs(x[static_cast<std::size_t>(i - std::max(first - per_bay_, 0))]);
      };
      double edge = 0;
      for (int r = 0; r < per_bay_; ++r) edge = std::max({edge, row(first + r), row(last - r)});
      has_decayed = edge <= rounding * row(j);
    }
    if (has_decayed) break;
  }
}

void TrackWindow::fill(Table& table, int bay) const {
  const int rows = (2 * reach_ + 1) * per_bay_, start = (bay - reach_) * per_bay_ - offset_;
  const int first = std::max(start, 0), last = std::min(start + rows, size_) - 1;
  table.bay = bay;
  table.columns.assign(static_cast<std::size_t>(per_bay_) * static_cast<std::size_t>(rows), 0.0);
  for (int c = 0; c < per_bay_; ++c) {
    const int j = bay * per_bay_ + c - offset_;
    if (j >= size_) break;  // the last bay of the track has no rail behind its sleeper
    factor_.solve_unit_in_part(
        j, first, last, table.columns.data() + static_cast<std::ptrdiff_t>(c) * rows + (first - start));
  }
}

const TrackWindow::Table& TrackWindow::table_of(int bay) {
  const int margin = model_.data().ends.bays + reach_;
  const bool is_interior = bay - first_bay_ > margin && first_bay_ + bays_ - bay > margin;
  // One table serves all like bays.
  const int stored = model_.is_uniform() && is_interior ? -2 : bay;
  const auto slot = stored == -2 ? tables_.size() - 1 : static_cast<std::size_t>(bay % bays_);
  Table& table = tables_[slot];
  if (table.bay == stored) return table;
  fill(table, bay);
  table.bay = stored;
  table.is_interior = is_interior;
  return table;
}

std::size_t TrackWindow::memory() const {
  std::size_t doubles = 4 * static_cast<std::size_t>(q_.size()) +
                        2 * static_cast<std::size_t>(size_) * static_cast<std::size_t>(padding_ + 1);
  for (const Table& table : tables_) doubles += table.columns.size();
  for (const Product* product : {&C_product_, &K_product_}) doubles += 2 * product->value.size();
  return 8 * doubles;
}

void TrackWindow::set_state(int first_bay, const Eigen::Ref<const VectorXd>& q,
                            const Eigen::Ref<const VectorXd>& qd, const Eigen::Ref<const VectorXd>& qdd) {
  move_to(first_bay);
  q_.segment(padding_, size_) = q.segment(offset_, size_);
  qd_.segment(padding_, size_) = qd.segment(offset_, size_);
  y_.segment(padding_, size_) = qdd.segment(offset_, size_);
}

void TrackWindow::move_to(int first_bay) {
  if (is_whole_track() && first_bay == 0) return;
  // The first and the last bay of the track end in a free rail: they are not like the others.
  require(!is_whole_track() && first_bay >= 1 && first_bay + bays_ < model_.bays(), model_.data().label(),
          "first bay of the window", first_bay, "",
          fmt::format("1 to {}: the track is too short for the passage", model_.bays() - bays_ - 1));
  const int shift = (first_bay - first_bay_) * per_bay_;
  if (shift == 0) return;
  for (VectorXd* v : {&q_, &qd_, &y_}) {
    double* const begin = v->data() + padding_;
    if (std::abs(shift) >= size_) {
      std::fill_n(begin, size_, 0.0);
    } else if (shift > 0) {
      std::copy(begin + shift, begin + size_, begin);
      std::fill(begin + size_ - shift, begin + size_, 0.0);
    } else {
      std::copy_backward(begin, begin + size_ + shift, begin + size_);
      std::fill_n(begin, -shift, 0.0);
    }
  }
  first_bay_ = first_bay;
  offset_ = first_bay * per_bay_;
  if (!model_.is_uniform()) factorise();
  for (Table& table : tables_)
    if (!table.is_interior) table.bay = -1;
}

void TrackWindow::subtract_end_damping(const VectorXd& rate, VectorXd& force) const {
  if (is_whole_track()) return;
  const int rows = (model_.data().ends.bays + 1) * per_bay_;
  for (const int first : {0, size_ - rows})
    force.segment(padding_ + first, rows).noalias() -=
        end_damping_.middleRows(first, rows) * rate.segment(padding_, size_);
}

void TrackWindow::predict() {
  const double h = h_;
  for (Eigen::Index i = 0; i < q_.size(); ++i) {
    rate_before_[i] = qd_[i];
    q_[i] += h * (qd_[i] + 0.25 * h * y_[i]);
    qd_[i] += 0.5 * h * y_[i];
  }
  y_.setZero();
  K_product_.subtract(offset_, size_, padding_, q_.data(), y_.data());
  C_product_.subtract(offset_, size_, padding_, qd_.data(), y_.data());
  subtract_end_damping(qd_, y_);
  factor_.solve_in_place(y_.data() + padding_);
}

PortMotion TrackWindow::free_motion(const PortShape& shape) const {
  PortMotion motion;
  for (std::size_t k = 0; k < static_cast<std::size_t>(shape.count); ++k) {
    if (!holds(shape.index[k])) continue;
    const int i = padding_ + shape.index[k] - offset_;
    const double q = q_[i] + 0.25 * h_ * h_ * y_[i];
    motion.displacement += shape.value[k] * q;
    motion.slope += shape.gradient[k] * q;
    motion.velocity += shape.value[k] * (qd_[i] + 0.5 * h_ * y_[i]);
  }
  return motion;
}

TrackWindow::Response TrackWindow::response(const PortShape& at, const PortShape& of) {
  Response sum;
  if (std::abs(at.index[0] - of.index[0]) > (reach_ + 2) * per_bay_) return sum;
  const int rows = (2 * reach_ + 1) * per_bay_;
  for (std::size_t l = 0; l < static_cast<std::size_t>(of.count); ++l) {
    const int bay = of.index[l] / per_bay_, start = (bay - reach_) * per_bay_;
    const double* const column =
        table_of(bay).columns.data() + static_cast<std::ptrdiff_t>(of.index[l] - bay * per_bay_) * rows;
    for (std::size_t k = 0; k < static_cast<std::size_t>(at.count); ++k) {
      const int row = at.index[k] - start;
      if (row < 0 || row >= rows) continue;
      sum.acceleration += at.value[k] * of.value[l] * column[row];
      sum.slope += at.gradient[k] * of.value[l] * column[row];
    }
  }
  return sum;
}

void TrackWindow::accept(const std::vector<PortShape>& shapes, const VectorXd& F) {
  const int rows = (2 * reach_ + 1) * per_bay_;
  for (std::size_t p = 0; p < shapes.size(); ++p) {
    const double force = F[static_cast<Eigen::Index>(p)];
    if (force == 0) continue;
    for (std::size_t k = 0; k < static_cast<std::size_t>(shapes[p].count); ++k) {
      const int index = shapes[p].index[k];
      if (!holds(index)) continue;
      const int bay = index / per_bay_, start = (bay - reach_) * per_bay_ - offset_;
      const int first = std::max(start, 0), count = std::min(start + rows, size_) - first;
      const double* const column =
          table_of(bay).columns.data() + static_cast<std::ptrdiff_t>(index - bay * per_bay_) * rows;
      y_.segment(padding_ + first, count) +=
          (force * shapes[p].value[k]) * VectorXd::Map(column + (first - start), count);
    }
  }
  q_ += 0.25 * h_ * h_ * y_;
  qd_ += 0.5 * h_ * y_;
}

double TrackWindow::dissipated_in_step() const {
  const VectorXd rate = 0.5 * (rate_before_ + qd_);
  VectorXd force = VectorXd::Zero(rate.size());
  C_product_.subtract(offset_, size_, padding_, rate.data(), force.data());
  subtract_end_damping(rate, force);
  return -h_ * rate.segment(padding_, size_).dot(force.segment(padding_, size_));
}

double TrackWindow::kinetic_energy() const {
  const auto v = qd_.segment(padding_, size_);
  return 0.5 * v.dot(M_.block(offset_, offset_, size_, size_) * v);
}

double TrackWindow::potential_energy() const {
  const auto u = q_.segment(padding_, size_);
  return 0.5 * u.dot(K_.block(offset_, offset_, size_, size_) * u);
}

}  // namespace easydyn::track

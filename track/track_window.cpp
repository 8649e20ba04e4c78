#include "track/track_window.hpp"

#include <algorithm>
#include <cmath>

#include "easydyn/require.hpp"

namespace easydyn::track {

using Eigen::VectorXd;

namespace {

// What the absorbing ends add to C of a track of so many bays.
SparseMatrix compute_end_damping(const TrackData& data, int bays) {
  require(bays >= 2 * data.ends.bays + 2, data.label(), "window", bays * data.sleeper_spacing, "m",
          fmt::format(">= {:g}, two absorbing ends of {} bays and two bays between them",
                      (2 * data.ends.bays + 2) * data.sleeper_spacing.value, data.ends.bays));
  TrackData without = data;
  without.ends.bays = 0;
  SparseMatrix E = SparseMatrix(TrackModel(data, bays).C() - TrackModel(without, bays).C());
  E.prune(0.0);
  return E;
}

// Whether two rows agree when the second is shifted back by `shift`.
bool rows_agree(const SparseMatrix& A, int row, int shift, double scale) {
  SparseMatrix::InnerIterator a(A, row), b(A, row + shift);
  for (; a && b; ++a, ++b)
    if (a.col() + shift != b.col() || !(std::abs(a.value() - b.value()) <= 1e-12 * scale)) return false;
  return !a && !b;
}

// Whether all bays between the absorbing ends are alike.
bool has_like_bays(const TrackModel& model, int per_bay) {
  const int margin = model.data().ends.bays + 1;
  for (const auto* matrix : {&model.M(), &model.C(), &model.K()}) {
    const SparseMatrix A = *matrix;
    const double scale = A.nonZeros() > 0 ? A.coeffs().abs().maxCoeff() : 0;
    for (int bay = margin; bay + 1 < model.bays() - margin; ++bay)
      for (int r = 0; r < per_bay; ++r)
        if (!rows_agree(A, bay * per_bay + r, per_bay, scale)) return false;
  }
  return true;
}

}  // namespace

TrackWindow::Rows::Rows(const SparseMatrix& A) {
  begin.reserve(static_cast<std::size_t>(A.rows()) + 1);
  begin.push_back(0);
  for (int i = 0; i < A.rows(); ++i) {
    for (SparseMatrix::InnerIterator it(A, i); it; ++it) {
      if (it.value() == 0) continue;
      column.push_back(static_cast<int>(it.col()));
      value.push_back(it.value());
    }
    begin.push_back(static_cast<int>(column.size()));
  }
}

template <class Use>
void TrackWindow::Rows::for_each_row(int offset, int size, int padding, const double* x, Use use) const {
  const double* const shifted = x + padding - offset;
  for (int i = 0; i < size; ++i) {
    const auto row = static_cast<std::size_t>(offset + i);
    double sum = 0;
    for (int k = begin[row]; k < begin[row + 1]; ++k)
      sum += value[static_cast<std::size_t>(k)] * shifted[column[static_cast<std::size_t>(k)]];
    use(i, sum);
  }
}

TrackWindow::TrackWindow(const TrackModel& model, int bays, double step)
    : model_(model),
      bays_(bays > 0 && bays + 2 <= model.bays() ? bays : model.bays()),
      per_bay_(model.sleepers() > 1 ? model.sleeper_dof(1) - model.sleeper_dof(0) : model.size()),
      size_(model.size() - (model.bays() - bays_) * per_bay_),
      padding_(model.half_bandwidth()),
      h_(step),
      is_uniform_(has_like_bays(model, per_bay_)),
      M_(model.M()),
      C_(is_whole_track()
             ? SparseMatrix(model.C())
             : SparseMatrix(SparseMatrix(model.C()) - compute_end_damping(model.data(), model.bays()))),
      K_(model.K()),
      end_damping_(is_whole_track() ? SparseMatrix(size_, size_) : compute_end_damping(model.data(), bays_)),
      C_rows_(C_),
      K_rows_(K_),
      end_rows_(end_damping_) {
  require_positive(model.data().label(), "time step", step, "s");
  for (VectorXd* v : {&q_, &qd_, &y_, &before_}) v->setZero(size_ + 2 * padding_);
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
  const int stored = is_uniform_ && is_interior ? -2 : bay;
  const auto slot = stored == -2 ? tables_.size() - 1 : static_cast<std::size_t>(bay % bays_);
  Table& table = tables_[slot];
  if (table.bay == stored) return table;
  fill(table, bay);
  table.bay = stored;
  table.is_interior = is_interior;
  return table;
}

double TrackWindow::inverse_entry(int row, int column) {
  const int bay = column / per_bay_, rows = (2 * reach_ + 1) * per_bay_;
  const int r = row - (bay - reach_) * per_bay_;
  if (r < 0 || r >= rows) return 0;
  return table_of(bay).columns[static_cast<std::size_t>((column - bay * per_bay_) * rows + r)];
}

std::size_t TrackWindow::memory() const {
  std::size_t doubles = 4 * static_cast<std::size_t>(q_.size()) +
                        2 * static_cast<std::size_t>(size_) * static_cast<std::size_t>(padding_ + 1);
  for (const Table& table : tables_) doubles += table.columns.size();
  for (const Rows* rows : {&C_rows_, &K_rows_, &end_rows_}) doubles += 2 * rows->value.size();
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
  if (!is_uniform_) factorise();
  for (Table& table : tables_)
    if (!table.is_interior) table.bay = -1;
}

void TrackWindow::predict() {
  before_ = qd_;
  q_ += h_ * qd_ + 0.25 * h_ * h_ * y_;
  qd_ += 0.5 * h_ * y_;
  double* const y = y_.data() + padding_;
  K_rows_.for_each_row(offset_, size_, padding_, q_.data(), [&](int i, double f) { y[i] = -f; });
  C_rows_.for_each_row(offset_, size_, padding_, qd_.data(), [&](int i, double f) { y[i] -= f; });
  if (!is_whole_track())
    end_rows_.for_each_row(0, size_, padding_, qd_.data(), [&](int i, double f) { y[i] -= f; });
  factor_.solve_in_place(y);
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

double TrackWindow::response(const PortShape& at, const PortShape& of) {
  double sum = 0;
  for (std::size_t l = 0; l < static_cast<std::size_t>(of.count); ++l)
    for (std::size_t k = 0; k < static_cast<std::size_t>(at.count); ++k)
      sum += at.value[k] * of.value[l] * inverse_entry(at.index[k], of.index[l]);
  return sum;
}

double TrackWindow::slope_response(const PortShape& at, const PortShape& of) {
  double sum = 0;
  for (std::size_t l = 0; l < static_cast<std::size_t>(of.count); ++l)
    for (std::size_t k = 0; k < static_cast<std::size_t>(at.count); ++k)
      sum += at.gradient[k] * of.value[l] * inverse_entry(at.index[k], of.index[l]);
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
  before_ = 0.5 * (before_ + qd_);
  double power = 0;
  const double* const v = before_.data() + padding_;
  C_rows_.for_each_row(offset_, size_, padding_, before_.data(), [&](int i, double f) { power += v[i] * f; });
  if (!is_whole_track())
    end_rows_.for_each_row(0, size_, padding_, before_.data(), [&](int i, double f) { power += v[i] * f; });
  dissipated_ = h_ * power;
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

#include "soil/block_tables.hpp"

#include <algorithm>
#include <utility>

#include "soil/gll.hpp"

namespace easydyn::soil {
namespace {

/// Elements of an axis that touch a node, first <= e < end.
struct ElementsAt {
  int first, end;
};

ElementsAt elements_at(int node, int degree, int count) {
  const int e = node / degree;
  return {node % degree == 0 && e > 0 ? e - 1 : e, std::min(e + 1, count)};
}

bool has_block(const Lattice& lattice, int ey, int ez) {
  return std::any_of(lattice.blocks.begin(), lattice.blocks.end(), [&](const LatticeBlock& block) {
    return block.y[0] <= ey && ey < block.y[1] && block.z[0] <= ez && ez < block.z[1];
  });
}

/// Whether a block changes the material of an element of the row.
bool has_other_material(const Lattice& lattice, int ey, int ez) {
  if (!has_block(lattice, ey, ez)) return false;
  for (int ex = 0; ex < lattice.nx(); ++ex)
    if (find_material(lattice, ex, ey, ez) != lattice.layer[ez]) return true;
  return false;
}

/// Whether a row with a block in it touches the line, also one of another rank.
bool touches_block(const Lattice& lattice, LinePlace line) {
  const ElementsAt y = elements_at(line.Y, lattice.degree, lattice.ny()),
                   z = elements_at(line.Z, lattice.degree, lattice.nz());
  for (int ez = z.first; ez < z.end; ++ez)
    for (int ey = y.first; ey < y.end; ++ey)
      if (has_block(lattice, ey, ez)) return true;
  return false;
}

}  // namespace

int find_material(const Lattice& lattice, int ex, int ey, int ez) {
  const auto is_in = [](const std::array<int, 2>& range, int e) { return range[0] <= e && e < range[1]; };
  for (auto block = lattice.blocks.rbegin(); block != lattice.blocks.rend(); ++block)
    if (is_in(block->x, ex) && is_in(block->y, ey) && is_in(block->z, ez)) return block->material;
  return lattice.layer[ez];
}

int count_nodes_with_mass(const Lattice& lattice, LinePlace line) {
  const int N = lattice.degree, nX = lattice.nx() * N + 1;
  const ElementsAt y = elements_at(line.Y, N, lattice.ny()), z = elements_at(line.Z, N, lattice.nz());
  if (!touches_block(lattice, line)) return nX;
  int count = 0;
  for (int X = 0; X < nX; ++X) {
    const ElementsAt x = elements_at(X, N, lattice.nx());
    bool has_mass = false;
    for (int ez = z.first; ez < z.end; ++ez)
      for (int ey = y.first; ey < y.end; ++ey)
        for (int ex = x.first; ex < x.end; ++ex)
          has_mass = has_mass || find_material(lattice, ex, ey, ez) >= 0;
    count += has_mass ? 1 : 0;
  }
  return count;
}

template <class T>
BlockTables<T>::BlockTables(const Lattice& lattice, const std::vector<EngineMaterial>& materials,
                            const AxisTables<T>& axes, int stride, const ElementBlock& part)
    : part_(part), first_{part.rows[0] * lattice.degree, part.slabs[0] * lattice.degree} {
  if (lattice.blocks.empty()) return;
  ones.assign(stride, T(1));
  hx.assign(stride, T(0));
  slope_x.assign(stride, T(0));
  for (int ex = 0; ex < lattice.nx(); ++ex) {
    const double h = lattice.x[ex + 1] - lattice.x[ex];
    hx[ex] = static_cast<T>(h);
    slope_x[ex] = static_cast<T>(2 / h);
  }
  make_rows(lattice, materials, stride);
  make_mass_lines(lattice, materials, axes, stride);
}

template <class T>
void BlockTables<T>::make_rows(const Lattice& lattice, const std::vector<EngineMaterial>& materials,
                               int stride) {
  rows_ = part_.rows[1] - part_.rows[0];
  row_index_.assign(static_cast<std::size_t>(part_.size()), -1);
  for (int ez = part_.slabs[0]; ez < part_.slabs[1]; ++ez)
    for (int ey = part_.rows[0]; ey < part_.rows[1]; ++ey) {
      if (!has_other_material(lattice, ey, ez)) continue;
      const int layer = lattice.layer[ez];
      Row row{lattice.nx(), 0, {}, {}, {}, {}, {}, {}, {}, {}};
      for (AlignedVector<T>* table : Row::tables_of(row)) table->assign(stride, T(0));
      for (int ex = 0; ex < lattice.nx(); ++ex) {
        const int material = find_material(lattice, ex, ey, ez);
        if (material == layer) continue;
        row.first = std::min(row.first, ex);
        row.last = ex + 1;
        const EngineMaterial& from = materials[layer];
        const EngineMaterial to = material < 0 ? EngineMaterial{} : materials[material];
        row.lambda[ex] = static_cast<T>(to.lambda);
        row.mu[ex] = static_cast<T>(to.mu);
        row.minus_lambda[ex] = static_cast<T>(-from.lambda);
        row.minus_mu[ex] = static_cast<T>(-from.mu);
        row.lambda_change[ex] = static_cast<T>(to.lambda - from.lambda);
        row.mu_change[ex] = static_cast<T>(to.mu - from.mu);
        row.beta[ex] = static_cast<T>(to.beta);
        for (std::size_t l = 0; l < to.memory_weights.size(); ++l)
          row.minus_weight[l][ex] = static_cast<T>(-to.memory_weights[l]);
      }
      row_index_[static_cast<std::size_t>(ez - part_.slabs[0]) * rows_ + (ey - part_.rows[0])] =
          static_cast<int>(row_.size());
      row_.push_back(std::move(row));
    }
}

template <class T>
void BlockTables<T>::make_mass_lines(const Lattice& lattice, const std::vector<EngineMaterial>& materials,
                                     const AxisTables<T>& axes, int stride) {
  const int N = lattice.degree, nX = lattice.nx() * N + 1;
  const GllRule rule(N);
  const auto density = [&](int ex, int ey, int ez) {
    const int material = find_material(lattice, ex, ey, ez);
    return material < 0 ? 0.0 : materials[material].density;
  };
  // The one or two elements of a node on an axis, each with its share of the node's length.
  struct Share {
    int element;
    double length;
  };
  const auto shares = [&](const std::vector<double>& lines, int node) {
    std::vector<Share> result;
    const int e = node / N, i = node % N;
    if (i == 0 && e > 0) result.push_back({e - 1, rule.weights(N) * (lines[e] - lines[e - 1]) / 2});
    if (e + 1 < static_cast<int>(lines.size()))
      result.push_back({e, rule.weights(i) * (lines[e + 1] - lines[e]) / 2});
    return result;
  };
  lines_ = rows_ * N + 1;
  const LinePlace end{part_.rows[1] * N + 1, part_.slabs[1] * N + 1};
  line_index_.assign(static_cast<std::size_t>(lines_) * (end.Z - first_.Z), -1);
  for (int Z = first_.Z; Z < end.Z; ++Z)
    for (int Y = first_.Y; Y < end.Y; ++Y) {
      if (!touches_block(lattice, {Y, Z})) continue;
      const std::vector<Share> in_y = shares(lattice.y, Y), in_z = shares(lattice.z, Z);
      MassLine line;
      line.ratio.assign(static_cast<std::size_t>(N) * stride, T(0));
      line.inverse.assign(static_cast<std::size_t>(N) * stride, T(0));
      for (int X = 0; X < nX; ++X) {
        double sum = 0;
        for (const Share& z : in_z)
          for (const Share& y : in_y)
            for (const Share& x : shares(lattice.x, X))
              sum += density(x.element, y.element, z.element) * x.length * y.length * z.length;
        const double ratio = sum / (axes.mx[X] * axes.my[Y] * axes.mz_density[Z]);
        const std::size_t place = static_cast<std::size_t>(X % N) * stride + X / N;
        line.ratio[place] = static_cast<T>(ratio);
        line.inverse[place] = static_cast<T>(ratio > 0 ? 1 / ratio : 0.0);
      }
      line_index_[static_cast<std::size_t>(Z - first_.Z) * lines_ + (Y - first_.Y)] =
          static_cast<int>(mass_line_.size());
      mass_line_.push_back(std::move(line));
    }
}

template <class T>
double BlockTables<T>::compute_memory(const Lattice& lattice, int stride, const ElementBlock& part) {
  if (lattice.blocks.empty()) return 0;
  const int N = lattice.degree;
  double rows = 0, lines = 0, all_lines = 0;
  for (int ez = part.slabs[0]; ez < part.slabs[1]; ++ez)
    for (int ey = part.rows[0]; ey < part.rows[1]; ++ey) rows += has_other_material(lattice, ey, ez) ? 1 : 0;
  for (int Z = part.slabs[0] * N; Z <= part.slabs[1] * N; ++Z)
    for (int Y = part.rows[0] * N; Y <= part.rows[1] * N; ++Y) {
      lines += touches_block(lattice, {Y, Z}) ? 1 : 0;
      ++all_lines;
    }
  constexpr auto tables =
      static_cast<double>(std::tuple_size_v<decltype(Row::tables_of(std::declval<Row&>()))>);
  const double along_x = sizeof(T) * static_cast<double>(stride);
  return along_x * (3 + tables * rows + 2 * N * lines) +
         sizeof(int) * (static_cast<double>(part.size()) + all_lines);
}

template <class T>
double BlockTables<T>::memory() const {
  std::size_t values = hx.size() + slope_x.size() + ones.size();
  for (const Row& row : row_)
    for (const AlignedVector<T>* table : Row::tables_of(row)) values += table->size();
  for (const MassLine& line : mass_line_) values += line.ratio.size() + line.inverse.size();
  return static_cast<double>(values * sizeof(T) + (row_index_.size() + line_index_.size()) * sizeof(int));
}

template class BlockTables<float>;
template class BlockTables<double>;

}  // namespace easydyn::soil

#include "soil/layered/wavenumber_response.hpp"

#include <cassert>
#include <cmath>
#include <limits>

namespace easydyn::soil {
namespace {

using Complex = std::complex<double>;
using Matrix = Eigen::Matrix2cd;

constexpr double invisible = 45;  // e^-45 is below the rounding of 1

Complex determinant(const Matrix& m) {
  return m(0, 0) * m(1, 1) - m(0, 1) * m(1, 0);
}

Matrix invert(const Matrix& m) {
  const Complex scale = 1.0 / determinant(m);
  Matrix inverse;
  inverse << m(1, 1) * scale, -m(0, 1) * scale, -m(1, 0) * scale, m(0, 0) * scale;
  return inverse;
}

// (x, z) -> (x, -z), and the same for a matrix on both sides.
Matrix mirror_rows(const Matrix& m) {
  Matrix mirrored = m;
  mirrored.row(1) *= -1;
  return mirrored;
}
Matrix mirror_both(const Matrix& m) {
  Matrix mirrored = m;
  mirrored(0, 1) *= -1;
  mirrored(1, 0) *= -1;
  return mirrored;
}

// The root of a wave that decays outward, or, undamped, travels outward (Im > 0 with exp(i w t - b z)).
Complex take_root(Complex square) {
  const Complex root = std::sqrt(square);
  return root.real() == 0 && root.imag() < 0 ? -root : root;
}

// (e^x - 1) / x
Complex relative_growth(Complex x) {
  if (std::norm(x) > 0.25) return (std::exp(x) - 1.0) / x;
  Complex sum = 1, term = 1;
  for (int n = 2; n < 16; ++n) {
    term *= x / double(n);
    sum += term;
  }
  return sum;
}

// How waves S, D at z = 0 read at z: upper triangular, (e^-bz, (e^-az - e^-bz) / ks2; 0, e^-az).
struct Propagator {
  Complex s, mixed, p;
};
Propagator propagate(Complex a, Complex b, double speed_ratio2, double z) {
  const Complex s = std::exp(-b * z), p = std::exp(-a * z);
  return {s, -z * (1 - speed_ratio2) / (a + b) * s * relative_growth((b - a) * z), p};
}
Matrix operator*(const Propagator& E, const Matrix& m) {
  Matrix product;
  product.row(0) = E.s * m.row(0) + E.mixed * m.row(1);
  product.row(1) = E.p * m.row(1);
  return product;
}
Matrix operator*(const Matrix& m, const Propagator& E) {
  Matrix product;
  product.col(0) = m.col(0) * E.s;
  product.col(1) = m.col(0) * E.mixed + m.col(1) * E.p;
  return product;
}

}  // namespace

WavenumberResponse::WavenumberResponse(const std::vector<LayerAtFrequency>& layers, double source_depth,
                                       const std::vector<double>& receiver_depths) {
  assert(!layers.empty() && source_depth >= 0);
  first_modulus_ = std::abs(layers.front().mu);
  above_.ends_free = true;
  double top = 0;
  std::vector<double> above_tops, below_tops;  // depth of the upper face of each piece
  for (std::size_t i = 0; i < layers.size(); ++i) {
    Piece piece{};
    piece.material = layers[i];
    const double bottom =
        i + 1 < layers.size() ? top + layers[i].thickness : std::numeric_limits<double>::infinity();
    if (top < source_depth) {
      piece.material.thickness = std::min(bottom, source_depth) - top;
      above_.pieces.insert(above_.pieces.begin(), piece);
      above_tops.insert(above_tops.begin(), top);
    }
    if (bottom > source_depth) {
      piece.material.thickness = bottom - std::max(top, source_depth);
      below_.pieces.push_back(piece);
      below_tops.push_back(std::max(top, source_depth));
    }
    top = bottom;
  }
  for (const double depth : receiver_depths) {
    assert(depth >= 0);
    Place place;
    if (depth > source_depth) {
      place.side = 1;
      while (place.piece + 1 < static_cast<int>(below_.pieces.size()) &&
             below_tops[static_cast<std::size_t>(place.piece) + 1] <= depth)
        ++place.piece;
      place.depth = depth - below_tops[static_cast<std::size_t>(place.piece)];
    } else if (depth < source_depth) {
      place.side = -1;
      while (above_tops[static_cast<std::size_t>(place.piece)] > depth) ++place.piece;
      const Piece& piece = above_.pieces[static_cast<std::size_t>(place.piece)];
      place.depth = above_tops[static_cast<std::size_t>(place.piece)] + piece.material.thickness - depth;
    }
    receivers_.push_back(place);
  }
}

void WavenumberResponse::Column::update(double k) {
  // Waves of each piece, as far as they reach.
  active = 0;
  double decay = 0;
  for (Piece& piece : pieces) {
    const LayerAtFrequency& m = piece.material;
    const double r = m.speed_ratio2;
    const Complex a = take_root(k * k - m.ks2 * r), b = take_root(k * k - m.ks2);
    piece.a = a;
    piece.b = b;
    piece.A << b, 1.0 / (k + b), k, -r / (k + a);
    piece.B << 2 * k * k - m.ks2, 1.0 - 2 * k * r / (k + a), 2 * k * b, m.ks2 / ((k + b) * (k + b));
    piece.B *= m.mu;
    ++active;
    decay += b.real() * m.thickness;
    if (decay > invisible) break;
  }
  const bool reaches_end = active == static_cast<int>(pieces.size());

  // Impedances from the outer end inward.
  Z.setZero();
  Z_y = 0;
  for (int i = active - 1; i >= 0; --i) {
    Piece& piece = pieces[static_cast<std::size_t>(i)];
    const LayerAtFrequency& m = piece.material;
    const bool open = i == active - 1 && !(reaches_end && ends_free);
    if (open) {
      piece.down = invert(piece.A);
      piece.reflected.setZero();
      Z = piece.B * piece.down;
      piece.down_y = 1;
      piece.reflected_y = 0;
      Z_y = m.mu * piece.b;
      continue;
    }
    const Propagator E = propagate(piece.a, piece.b, m.speed_ratio2, m.thickness);
    const Matrix A_up = mirror_rows(piece.A), B_up = -mirror_rows(piece.B);
    piece.Z_below = Z;
    const Matrix R = -(invert(B_up - Z * A_up) * (piece.B - Z * piece.A));
    piece.reflected = R * E;
    const Matrix back = E * piece.reflected;
    piece.down = invert(piece.A + A_up * back);
    Z = (piece.B + B_up * back) * piece.down;

    const Complex stiffness = m.mu * piece.b;
    piece.reflected_y = (stiffness - Z_y) / (stiffness + Z_y) * E.s;
    const Complex back_y = E.s * piece.reflected_y;
    piece.down_y = 1.0 / (1.0 + back_y);
    Z_y = stiffness * (1.0 - back_y) * piece.down_y;
  }
}

void WavenumberResponse::Column::update_displacement(int place, double depth, const Matrix& at_source,
                                                     Complex at_source_y, Matrix& u, Complex& u_y) const {
  u.setZero();
  u_y = 0;
  if (place >= active) return;
  Matrix start = at_source;
  Complex start_y = at_source_y;
  for (int i = 0;; ++i) {
    const Piece& piece = pieces[static_cast<std::size_t>(i)];
    const double r = piece.material.speed_ratio2, h = piece.material.thickness;
    const double z = i == place ? depth : h;
    const Matrix waves = piece.down * start;
    const Complex wave_y = piece.down_y * start_y;
    const Propagator down = propagate(piece.a, piece.b, r, z);
    Matrix field = piece.A * (down * waves);
    Complex field_y = down.s * wave_y;
    if (std::isfinite(h)) {
      const Propagator up = propagate(piece.a, piece.b, r, h - z);
      field += mirror_rows(piece.A) * (up * (piece.reflected * waves));
      field_y += up.s * piece.reflected_y * wave_y;
    }
    if (i == place) {
      u = field;
      u_y = field_y;
      return;
    }
    start = field;
    start_y = field_y;
  }
}

void WavenumberResponse::update(double k, WavenumberCompliance* out) {
  below_.update(k);
  Matrix Z = below_.Z;
  Complex Z_y = below_.Z_y;
  if (!above_.pieces.empty()) {
    above_.update(k);
    Z += mirror_both(above_.Z);
    Z_y += above_.Z_y;
  }
  const Matrix G = invert(Z);
  const Complex G_y = 1.0 / Z_y;
  for (std::size_t r = 0; r < receivers_.size(); ++r) {
    const Place& place = receivers_[r];
    Matrix u = G;
    Complex u_y = G_y;
    if (place.side > 0) {
      below_.update_displacement(place.piece, place.depth, G, G_y, u, u_y);
    } else if (place.side < 0) {
      above_.update_displacement(place.piece, place.depth, mirror_rows(G), G_y, u, u_y);
      u = mirror_rows(u);
    }
    out[r] = {u(0, 0), u(0, 1), u(1, 0), u(1, 1), u_y};
  }
}

Complex WavenumberResponse::compute_surface_determinant(double k) {
  assert(above_.pieces.empty());
  below_.update(k);
  const double scale = first_modulus_ * k;
  return determinant(below_.Z) / (scale * scale);
}

Complex WavenumberResponse::compute_dispersion_function(double k) {
  Complex product = compute_surface_determinant(k);
  for (int i = 0; i + 1 < below_.active; ++i) {
    const Piece& piece = below_.pieces[static_cast<std::size_t>(i)];
    const LayerAtFrequency& m = piece.material;
    const Complex at_end = determinant(-mirror_rows(piece.B) - piece.Z_below * mirror_rows(piece.A));
    const Complex phase = std::exp(Complex(0, -m.thickness * (piece.a + piece.b).imag()));
    // Divided by |det A|^2, which has no zero, and by |mu|^2 so that it is of order 1 in every layer.
    product *= at_end /
               (determinant(piece.down) * piece.a * piece.b * phase * std::norm(m.mu * determinant(piece.A)));
  }
  return product;
}

}  // namespace easydyn::soil

#include "soil/layered/superposition.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <map>
#include <numbers>
#include <numeric>
#include <optional>
#include <unsupported/Eigen/FFT>

#include "easydyn/error.hpp"
#include "soil/frequency_filter.hpp"
#include "soil/layered/superposition_memory.hpp"
#include "soil/load_history.hpp"
#include "soil/parallel_loop.hpp"
#include "soil/physical_memory.hpp"

namespace easydyn::soil {
namespace {

using Eigen::Index;
constexpr double pi = std::numbers::pi;
constexpr double unload_time = 0.5;  // [s] after the record, over which held loads go back to zero
constexpr double tolerance = 1e-3;   // [m] to which distances are met

// Columns of `signals`, the first `before` rows of them before t = 0, on a circle of `length` samples, as half spectra
// up to `count` lines.
Eigen::MatrixXcd transform(const Eigen::MatrixXd& signals, Index before, Index length, Index count,
                           int threads) {
  Eigen::MatrixXcd spectra(count, signals.cols());
  for_each_chunk(signals.cols(), threads, [&](Index begin, Index end) {
    Eigen::FFT<double> fft;
    fft.SetFlag(Eigen::FFT<double>::HalfSpectrum);
    Eigen::VectorXd circle = Eigen::VectorXd::Zero(length);
    Eigen::VectorXcd spectrum(length / 2 + 1);
    for (Index c = begin; c < end; ++c) {
      circle.head(signals.rows() - before) = signals.col(c).tail(signals.rows() - before);
      circle.tail(before) = signals.col(c).head(before);
      fft.fwd(spectrum.data(), circle.data(), static_cast<int>(length));
      spectra.col(c) = spectrum.head(count);
    }
  });
  return spectra;
}

// The places of a mobility by their distance.
template <std::size_t N>
class Finder {
 public:
  explicit Finder(const std::vector<std::array<double, N>>& places) {
    for (std::size_t i = 0; i < places.size(); ++i) index_[key(places[i])] = static_cast<Index>(i);
  }
  /// -1: there is none.
  Index find(std::array<double, N> place) const {
    const std::array<long, N> centre = key(place);
    // Either side of the rounding.
    const auto at = index_.find(centre);
    if (at != index_.end()) return at->second;
    std::array<long, N> near = centre;
    for (near[0] = centre[0] - 1; near[0] <= centre[0] + 1; ++near[0]) {
      for (near[1] = centre[1] - 1; near[1] <= centre[1] + 1; ++near[1]) {
        if (const auto beside = index_.find(near); beside != index_.end()) return beside->second;
      }
    }
    return -1;
  }

 private:
  static std::array<long, N> key(const std::array<double, N>& place) {
    std::array<long, N> rounded;
    for (std::size_t i = 0; i < N; ++i) rounded[i] = std::lround(std::abs(place[i]) / tolerance);
    return rounded;
  }
  std::map<std::array<long, N>, Index> index_;
};

// Samples of loads from `start` on, until they are back at zero after `end`.
Index count_samples(double start, double end, double step) {
  return static_cast<Index>(std::ceil((end + unload_time - start) / step)) + 1;
}

// The loads at the step of the responses, tapered, from `start` on, back to zero after `end`.
Eigen::MatrixXd sample_loads(const LoadHistory& history, const Eigen::VectorXd& taper, double start,
                             double end, double step, int threads) {
  const Index samples = count_samples(start, end, step);
  Eigen::MatrixXd force(taper.size(), samples);
  for_each_chunk(samples, threads, [&](Index first, Index last) {
    Eigen::VectorXd at;
    for (Index i = first; i < last; ++i) {
      const double t = start + step * static_cast<double>(i);
      history.update_forces(t, at);
      const double s = std::clamp((t - end) / unload_time, 0.0, 1.0);
      force.col(i) = (1 - s * s * s * (10 - 15 * s + 6 * s * s)) * at.cwiseProduct(taper);
    }
  });
  return force.transpose();
}

// Footprints in a row along x at one spacing, loaded in one direction.
struct EvenRow {
  LoadDirection direction = LoadDirection::down;
  double spacing = 0;            // [m]
  std::vector<Index> footprint;  // in the order of x
};
// Nothing where they are not, or where there is only one.
std::optional<EvenRow> find_even_row(const std::vector<Footprint>& footprints) {
  const std::size_t count = footprints.size();
  if (count < 2) return {};
  EvenRow row;
  row.footprint.resize(count);
  std::iota(row.footprint.begin(), row.footprint.end(), Index{0});
  const auto at = [&](std::size_t i) -> const Footprint& {
    return footprints[static_cast<std::size_t>(row.footprint[i])];
  };
  std::sort(row.footprint.begin(), row.footprint.end(), [&](Index i, Index j) {
    return footprints[static_cast<std::size_t>(i)].x < footprints[static_cast<std::size_t>(j)].x;
  });
  row.spacing = (at(count - 1).x - at(0).x) / static_cast<double>(count - 1);
  if (row.spacing <= 2 * tolerance) return {};
  for (std::size_t i = 0; i < count; ++i) {
    if (std::abs(at(i).x - at(0).x - row.spacing * static_cast<double>(i)) > tolerance / 2 ||
        std::abs(at(i).y - at(0).y) > tolerance / 2 || at(i).direction != at(0).direction)
      return {};
  }
  row.direction = at(0).direction;
  return row;
}

// Place of a direction in x, y, z.
std::size_t component(LoadDirection direction) {
  return direction == LoadDirection::x ? 0 : direction == LoadDirection::y ? 1 : 2;
}

class Superposition {
 public:
  Superposition(const Mobility& mobility, const Site& site, const SurfaceLoads& loads,
                const SuperpositionOptions& options)
      : mobility_(mobility), site_(site), loads_(loads), refinement_(options.samples_per_period / 4) {
    const double preload_time = options.preload_time;
    if (options.samples_per_period < 4 || options.samples_per_period % 4 != 0) {
      throw ModelError(fmt::format("superposition: samples_per_period = {}, must be a multiple of 4, > 0",
                                   options.samples_per_period));
    }
    threads_ = count_threads(options.threads);
    if (mobility.highest_frequency < site.highest_frequency * (1 - 1e-9)) {
      throw ModelError(
          fmt::format("superposition: responses up to {} Hz, must be at least {} Hz, the highest frequency",
                      mobility.highest_frequency, site.highest_frequency));
    }
    for (std::size_t j = 0; j < loads.footprints.size(); ++j) {
      const Footprint& f = loads.footprints[j];
      if (std::abs(f.length - mobility.length) > 1e-6 || std::abs(f.width - mobility.width) > 1e-6) {
        throw ModelError(fmt::format(
            "superposition: {} is {} m x {} m, must be {} m x {} m, that of the "
            "responses (soil run takes any sizes)",
            name_footprint(loads.footprints, j), f.length, f.width, mobility.length, mobility.width));
      }
      if (f.direction != LoadDirection::down && !mobility.horizontal.contains(f.direction)) {
        throw ModelError(
            fmt::format("superposition: no responses to a load along {}, which footprint {} needs",
                        f.direction == LoadDirection::x ? "x" : "y", j + 1));
      }
    }
    first_ = loads.time(0);
    duration_ =
        site.duration > 0 ? site.duration : loads.time(loads.time.size() - 1) - first_ + site.decay_time;
    if (!(duration_ > 0) || !std::isfinite(duration_)) {
      throw ModelError(fmt::format("site: duration = {} s, must be > 0", duration_));
    }
    check_memory(options);
    SurfaceLoads limited = loads;
    const double step =
        (loads.time(loads.time.size() - 1) - loads.time(0)) / static_cast<double>(loads.time.size() - 1);
    for_each_chunk(loads.force.cols(), threads_, [&](Index begin, Index end) {
      limited.force.middleCols(begin, end - begin) =
          limit_band(loads.force.middleCols(begin, end - begin), step, site.highest_frequency);
    });
    const LoadHistory history(limited, preload_time);
    motion_.taper = compute_taper(loads.footprints, site.taper_length);

    // As in the finite elements: a start below 1/1000 of the largest force does no harm as it is.
    Eigen::VectorXd start;
    history.update_forces(first_ + 1e-12, start);
    const bool preloaded =
        start.cwiseProduct(motion_.taper).cwiseAbs().maxCoeff() > 1e-3 * limited.force.cwiseAbs().maxCoeff();
    before_ = preloaded ? static_cast<Index>(std::ceil(preload_time / mobility.step)) : 0;
    const Eigen::MatrixXd force =
        sample_loads(history, motion_.taper, first_ - mobility.step * static_cast<double>(before_),
                     first_ + duration_, mobility.step, threads_);
    length_ = compute_fast_length(force.rows() + mobility.hz.rows());
    count_ = count_lines(length_);
    forces_ = transform(force, 0, length_, count_, threads_);
  }

  GroundMotion run() {
    const Index outputs = count_outputs();
    motion_.time = Eigen::VectorXd::LinSpaced(
        outputs, first_, first_ + static_cast<double>(outputs - 1) * mobility_.step / refinement_);
    add_receivers();
    add_footprints();
    return std::move(motion_);
  }

 private:
  Index count_outputs() const {
    return static_cast<Index>(std::floor(duration_ / mobility_.step * refinement_ + 1e-9)) + 1;
  }
  // The loads hold nothing beyond their roll-off.
  Index count_lines(Index length) const {
    return std::min(length / 2, static_cast<Index>(std::ceil(roll_off * mobility_.highest_frequency *
                                                             mobility_.step * static_cast<double>(length))) +
                                    1);
  }

  // As if the loads start away from zero: half a second more.
  void check_memory(const SuperpositionOptions& options) const {
    SuperpositionSize size;
    size.footprints = static_cast<Index>(loads_.footprints.size());
    size.receivers = static_cast<Index>(site_.receivers.size());
    size.places = static_cast<Index>(mobility_.places.size());
    size.shifts = static_cast<Index>(mobility_.shifts.size());
    size.horizontal = static_cast<Index>(mobility_.horizontal.size());
    size.given = loads_.time.size();
    size.samples = count_samples(0, duration_ + options.preload_time, mobility_.step);
    size.circle = compute_fast_length(size.samples + mobility_.hz.rows());
    size.lines = count_lines(size.circle);
    size.outputs = count_outputs();
    size.refinement = refinement_;
    size.threads = threads_;
    size.is_even_row = find_even_row(loads_.footprints).has_value();
    const double kept = 8 * static_cast<double>(mobility_.hz.rows()) *
                            static_cast<double>((3 * size.places + size.shifts) +
                                                3 * size.horizontal * (size.places + size.shifts)) +
                        8 * static_cast<double>(loads_.force.size());
    require_memory(
        kept + estimate_memory(size),
        fmt::format("superposition: loads, responses and spectra of {} footprints and {} receivers over "
                    "{:.4g} s",
                    size.footprints, size.receivers, duration_),
        "take fewer receivers at a time, loads of a shorter passage or duration, or a lower "
        "highest_frequency",
        options.memory_limit);
  }

  // Indices of the response from every footprint; throws where one is missing.
  void add_receivers() {
    const Finder<3> finder(mobility_.places);
    const auto nr = static_cast<Index>(site_.receivers.size()), nl = forces_.cols();
    std::map<LoadDirection, std::array<Eigen::MatrixXcd, 3>> responses;
    responses[LoadDirection::down] = {transform_responses(mobility_.hx), transform_responses(mobility_.hy),
                                      transform_responses(mobility_.hz)};
    for (const auto& [direction, of] : mobility_.horizontal)
      responses[direction] = {transform_responses(of.hx), transform_responses(of.hy),
                              transform_responses(of.hz)};
    Eigen::MatrixXcd sums[3];
    for (Eigen::MatrixXcd& sum : sums) sum = Eigen::MatrixXcd::Zero(count_, nr);
    for_each_parallel(nr, threads_, [&](Index r) {
      const Receiver& receiver = site_.receivers[static_cast<std::size_t>(r)];
      for (Index j = 0; j < nl; ++j) {
        const Footprint& f = loads_.footprints[static_cast<std::size_t>(j)];
        const double dx = receiver.position[0] - f.x, dy = receiver.position[1] - f.y;
        const Index p = finder.find({dx, dy, receiver.position[2]});
        if (p < 0) {
          throw ModelError(
              fmt::format("superposition: no response at ({:.6g}, {:.6g}, {:.6g}) m from a footprint, which "
                          "receiver \"{}\" and footprint {} need",
                          std::abs(dx), std::abs(dy), receiver.position[2], receiver.name, j + 1));
        }
        const std::array<double, 3> signs = symmetry_signs(f.direction, dx, dy);
        const std::array<Eigen::MatrixXcd, 3>& h = responses.at(f.direction);
        for (std::size_t c = 0; c < 3; ++c)
          sums[c].col(r).array() += signs[c] * h[c].col(p).array() * forces_.col(j).array();
      }
    });
    const Eigen::VectorXcd rate = Eigen::VectorXcd::NullaryExpr(count_, [&](Index i) {
      return std::complex<double>(
          0, 2 * pi * static_cast<double>(i) / (static_cast<double>(length_) * mobility_.step));
    });
    Eigen::MatrixXd* const v[3] = {&motion_.vx, &motion_.vy, &motion_.vz};
    for (int c = 0; c < 3; ++c) *v[c] = transform_back(rate.asDiagonal() * sums[c]);
  }

  void add_footprints() {
    // Of each direction: mean displacement along x, along y and downward.
    std::map<LoadDirection, std::array<Eigen::MatrixXcd, 3>> means;
    means[LoadDirection::down][2] = transform_responses(mobility_.mean);
    for (const auto& [direction, of] : mobility_.horizontal)
      means[direction] = {transform_responses(of.mean_x), transform_responses(of.mean_y),
                          transform_responses(of.mean)};
    const std::optional<EvenRow> row = find_even_row(loads_.footprints);
    motion_.footprint_displacement = transform_back(
        row ? sum_even_row(means.at(row->direction)[component(row->direction)], *row) : sum_pairs(means));
  }

  // Index of the response of footprint i to footprint j; throws where it is missing.
  Index find_response(const Finder<2>& finder, Index i, Index j) const {
    const Footprint &to = loads_.footprints[static_cast<std::size_t>(i)],
                    &from = loads_.footprints[static_cast<std::size_t>(j)];
    const Index index = finder.find({to.x - from.x, to.y - from.y});
    if (index < 0) {
      throw ModelError(
          fmt::format("superposition: no response of a footprint at ({:.6g}, {:.6g}) m, which footprints "
                      "{} and {} need",
                      std::abs(to.x - from.x), std::abs(to.y - from.y), j + 1, i + 1));
    }
    return index;
  }

  // Displacements of the footprints, each along its load, pair by pair.
  Eigen::MatrixXcd sum_pairs(const std::map<LoadDirection, std::array<Eigen::MatrixXcd, 3>>& means) const {
    const Finder<2> finder(mobility_.shifts);
    Eigen::MatrixXcd sums = Eigen::MatrixXcd::Zero(count_, forces_.cols());
    for_each_parallel(forces_.cols(), threads_, [&](Index i) {
      for (Index j = 0; j < forces_.cols(); ++j) {
        const Footprint *to = &loads_.footprints[static_cast<std::size_t>(i)],
                        *from = &loads_.footprints[static_cast<std::size_t>(j)];
        if (from->direction == LoadDirection::down) std::swap(to, from);  // reciprocity
        const std::size_t c = component(to->direction);
        const double sign = symmetry_signs(from->direction, to->x - from->x, to->y - from->y)[c];
        sums.col(i).array() += sign * means.at(from->direction)[c].col(find_response(finder, i, j)).array() *
                               forces_.col(j).array();
      }
    });
    return sums;
  }

  // The same along an even row, all in one direction: a convolution over the footprints, by FFT at every frequency.
  Eigen::MatrixXcd sum_even_row(const Eigen::MatrixXcd& h, const EvenRow& row) const {
    const Finder<2> finder(mobility_.shifts);
    const Index nl = forces_.cols(), circle = compute_fast_length(2 * nl - 1);
    std::vector<Index> response;
    for (const Index footprint : row.footprint)
      response.push_back(find_response(finder, footprint, row.footprint.front()));
    const Eigen::MatrixXcd forces = forces_(Eigen::all, row.footprint).transpose();
    const Eigen::MatrixXcd responses = h(Eigen::all, response).transpose();
    Eigen::MatrixXcd sums(nl, count_);
    for_each_chunk(count_, threads_, [&](Index begin, Index end) {
      Eigen::FFT<double> fft;
      Eigen::VectorXcd f = Eigen::VectorXcd::Zero(circle), g = f, F(circle), G(circle);
      for (Index i = begin; i < end; ++i) {
        f.head(nl) = forces.col(i);
        g.head(nl) = responses.col(i);
        g.tail(nl - 1) = responses.col(i).tail(nl - 1).reverse();
        fft.fwd(F.data(), f.data(), circle);
        fft.fwd(G.data(), g.data(), circle);
        F.array() *= G.array();
        fft.inv(G.data(), F.data(), circle);
        sums.col(i) = G.head(nl);
      }
    });
    Eigen::MatrixXcd ordered(count_, nl);
    ordered(Eigen::all, row.footprint) = sums.transpose();
    return ordered;
  }

  Eigen::MatrixXcd transform_responses(const Eigen::MatrixXd& h) const {
    return mobility_.step * transform(h, mobility_.before, length_, count_, threads_);
  }

  // To the finer step of the output, without the samples before the loads.
  Eigen::MatrixXd transform_back(const Eigen::MatrixXcd& spectra) const {
    const Index length = refinement_ * length_;
    Eigen::MatrixXd signals(motion_.time.size(), spectra.cols());
    for_each_chunk(spectra.cols(), threads_, [&](Index begin, Index end) {
      Eigen::FFT<double> fft;
      fft.SetFlag(Eigen::FFT<double>::HalfSpectrum);
      Eigen::VectorXcd padded = Eigen::VectorXcd::Zero(length / 2 + 1);
      Eigen::VectorXd signal(length);
      for (Index c = begin; c < end; ++c) {
        padded.head(count_) = spectra.col(c);
        padded(0) = padded(0).real();
        fft.inv(signal.data(), padded.data(), static_cast<int>(length));
        signals.col(c) = refinement_ * signal.segment(refinement_ * before_, signals.rows());
      }
    });
    return signals;
  }

  const Mobility& mobility_;
  const Site& site_;
  const SurfaceLoads& loads_;
  int refinement_;  // steps of the output in a step of the responses
  int threads_ = 1;
  double first_ = 0, duration_ = 0;
  Index before_ = 0, length_ = 0, count_ = 0;
  Eigen::MatrixXcd forces_;
  GroundMotion motion_;
};

}  // namespace

GroundMotion superpose(const Mobility& mobility, const Site& site, const SurfaceLoads& loads,
                       const SuperpositionOptions& options) {
  return Superposition(mobility, site, loads, options).run();
}

}  // namespace easydyn::soil

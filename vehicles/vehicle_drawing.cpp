#include "vehicles/vehicle_drawing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>

#include "easydyn/require.hpp"
#include "easydyn/results/pending_file.hpp"
#include "vehicles/axle_loads.hpp"

namespace easydyn::vehicles {
namespace {

constexpr double margin = 30;  // [px] at either side
constexpr double text_size = 11;
constexpr const char *ink = "#222222", *soft_ink = "#666666", *pale = "#c4c4c4", *body_fill = "#dfe9f3",
                     *body_line = "#335b82", *frame_fill = "#bb5566", *wheel_fill = "#f4f4f4",
                     *spring_line = "#2f7d32", *rail_line = "#555555";

/// Part of the vehicle on one line of the drawing: bodies first to last.
struct Row {
  std::size_t first, last;
  double front, rear;  // [m]
};

struct Span {
  double front, rear;
};
Span span_of(const CarBody& body) {
  const double middle = body.x + body.middle_offset;
  return {middle + body.length / 2, middle - body.length / 2};
}

bool carries(const RunningGear& gear, const CarBody& body) {
  return gear.body == body.name ||
         std::ranges::any_of(gear.secondaries, [&](const auto& s) { return s.body == body.name; });
}

std::vector<Row> rows_of(const RailVehicle& vehicle, double row_length) {
  std::vector<Row> rows;
  for (std::size_t i = 0; i < vehicle.bodies.size(); ++i) {
    const Span span = span_of(vehicle.bodies[i]);
    if (rows.empty() || rows.back().front - span.rear > row_length)
      rows.push_back({i, i, span.front, span.rear});
    Row& row = rows.back();
    row.last = i;
    row.front = std::max(row.front, span.front);
    row.rear = std::min(row.rear, span.rear);
  }
  for (Row& row : rows)  // gears may stand beyond their bodies
    for (const RunningGear& gear : vehicle.gears)
      for (std::size_t i = row.first; i <= row.last; ++i) {
        if (!carries(gear, vehicle.bodies[i])) continue;
        for (const WheelPair& pair : gear.wheel_pairs) {
          row.front = std::max(row.front, pair.x + pair.radius);
          row.rear = std::min(row.rear, pair.x - pair.radius);
        }
      }
  return rows;
}

std::string escaped(const std::string& text) {
  std::string safe;
  for (const char c : text) {
    switch (c) {
      case '&':
        safe += "&amp;";
        break;
      case '<':
        safe += "&lt;";
        break;
      case '>':
        safe += "&gt;";
        break;
      case '"':
        safe += "&quot;";
        break;
      default:
        safe += c;
    }
  }
  return safe;
}

/// Metres to the millimetre, to the centimetre where that is enough.
std::string length_text(double metres) {
  std::string text = fmt::format("{:.3f}", metres);
  if (text.back() == '0') text.pop_back();
  return text;
}

/// SVG elements, in pixels from the upper left corner.
class Canvas {
 public:
  template <class... Args>
  void add(fmt::format_string<Args...> format, Args&&... args) {
    fmt::format_to(std::back_inserter(svg_), format, std::forward<Args>(args)...);
    svg_ += '\n';
  }
  void line(double x1, double y1, double x2, double y2, const char* colour, double width = 1) {
    add(R"(<line x1="{:.1f}" y1="{:.1f}" x2="{:.1f}" y2="{:.1f}" stroke="{}" stroke-width="{:g}"/>)", x1, y1,
        x2, y2, colour, width);
  }
  void text(double x, double y, const std::string& words, const char* anchor = "middle",
            const char* colour = ink, double size = text_size, bool is_bold = false) {
    add(R"(<text x="{:.1f}" y="{:.1f}" text-anchor="{}" fill="{}" font-size="{:g}"{}>{}</text>)", x, y,
        anchor, colour, size, is_bold ? R"( font-weight="bold")" : "", escaped(words));
  }
  /// Zigzag from (x, top) to (x, bottom).
  void spring(double x, double top, double bottom, double half_width, const char* colour) {
    const int turns = bottom - top < 14 ? 2 : 4;
    std::string points = fmt::format("{:.1f},{:.1f}", x, top);
    for (int i = 0; i < 2 * turns; ++i)
      points += fmt::format(" {:.1f},{:.1f}", x + (i % 2 == 0 ? half_width : -half_width),
                            top + (bottom - top) * (i + 0.5) / (2 * turns));
    points += fmt::format(" {:.1f},{:.1f}", x, bottom);
    add(R"(<polyline points="{}" fill="none" stroke="{}" stroke-width="1.2"/>)", points, colour);
  }
  /// Horizontal dimension between x1 < x2, its number above the line, or beside it where there is no room.
  void dimension(double x1, double x2, double y, double metres, double lines_from) {
    const std::string number = length_text(metres);
    const double room = text_size * 0.6 * static_cast<double>(number.size()) + 4;
    for (const double x : {x1, x2}) {
      line(x, lines_from, x, y + 4, pale, 0.7);
      line(x - 3, y + 3, x + 3, y - 3, soft_ink, 1);
    }
    line(x1, y, x2, y, soft_ink, 0.8);
    if (x2 - x1 >= room)
      number_on_line((x1 + x2) / 2, y - 3, number, "middle");
    else
      number_on_line(x2 + 5, y - 3, number, "start");
  }
  /// Text that keeps clear of the lines behind it.
  void number_on_line(double x, double y, const std::string& number, const char* anchor) {
    add(R"(<text x="{:.1f}" y="{:.1f}" text-anchor="{}" fill="{}" font-size="{:g}" stroke="#ffffff" stroke-width="3" paint-order="stroke">{}</text>)",
        x, y, anchor, soft_ink, text_size, number);
  }
  const std::string& svg() const { return svg_; }

 private:
  std::string svg_;
};

class Drawing {
 public:
  Drawing(const RailVehicle& vehicle, const DrawingOptions& options)
      : vehicle_(vehicle), loads_(compute_axle_loads(vehicle)), rows_(rows_of(vehicle, options.row_length)) {
    double longest = 0;
    for (const Row& row : rows_) longest = std::max(longest, row.front - row.rear);
    scale_ = std::min(48.0, (options.width - 2 * margin) / longest);
    width_ = options.width;
    for (const RunningGear& gear : vehicle.gears)
      for (const WheelPair& pair : gear.wheel_pairs)
        highest_wheel_ = std::max(highest_wheel_, 2 * pair.radius);
    body_height_ = options.body_height;
  }

  std::string svg() {
    double y = title();
    for (std::size_t r = 0; r < rows_.size(); ++r) y = row(rows_[r], r, y);
    canvas_.text(
        margin, y + 6,
        "Lengths and wheels to scale; heights of bodies and suspensions are symbols. Axle loads in kN, both "
        "rails; dimensions in m.",
        "start", soft_ink, 10);
    return fmt::format(
        R"(<svg xmlns="http://www.w3.org/2000/svg" width="{0:.0f}" height="{1:.0f}" viewBox="0 0 {0:.0f} {1:.0f}" )"
        R"(role="img" font-family="DejaVu Sans, Verdana, sans-serif">)"
        "\n<title>{2}</title>\n"
        R"(<rect width="100%" height="100%" fill="#ffffff"/>)"
        "\n{3}</svg>\n",
        width_, y + 18, escaped("Side elevation of " + vehicle_.label()), canvas_.svg());
  }

 private:
  const RailVehicle& vehicle_;
  AxleLoads loads_;
  std::vector<Row> rows_;
  double scale_ = 1, width_ = 0, highest_wheel_ = 0, body_height_ = 0;
  double left_ = 0, row_rear_ = 0;  // of the row being drawn: pixel of its rear end
  Canvas canvas_;

  double px(double x) const { return left_ + (x - row_rear_) * scale_; }

  double title() {
    canvas_.text(margin, 24, vehicle_.name, "start", ink, 16, true);
    canvas_.text(margin, 42,
                 fmt::format("length {:.2f} m, mass {:.2f} t, {} axles, mean axle load {:.1f} kN",
                             vehicle_.length.value, vehicle_.mass() / 1e3, vehicle_.wheel_pair_count(),
                             vehicle_.weight() / vehicle_.wheel_pair_count() / 1e3),
                 "start", soft_ink, 12);
    const double x = width_ - margin, y = 30;
    canvas_.text(x - 42, y + 4, "forward", "end", soft_ink, 11);
    canvas_.line(x - 36, y, x - 4, y, soft_ink, 1.2);
    canvas_.add(R"(<path d="M{:.1f} {:.1f} l-8 -4 v8 z" fill="{}"/>)", x, y, soft_ink);
    return 56;
  }

  bool stands_in(const RunningGear& gear, const Row& row) const {
    for (std::size_t i = row.first; i <= row.last; ++i)
      if (carries(gear, vehicle_.bodies[i])) return true;
    return false;
  }

  /// Draws one row below y; returns where it ends.
  double row(const Row& row, std::size_t number, double y) {
    row_rear_ = row.rear;
    left_ = (width_ - (row.front - row.rear) * scale_) / 2;
    if (rows_.size() > 1) {
      canvas_.text(
          margin, y + 12,
          fmt::format("{} of {}:  x = {:.2f} to {:.2f} m", number + 1, rows_.size(), row.rear, row.front),
          "start", soft_ink, 10);
      y += 14;
    }
    const double suspension = std::max(0.25 * scale_, 7.0);  // symbol of a suspension [px]
    const double roof = y + 8, floor = roof + body_height_ * scale_;
    const double wheel_top = floor + suspension + 2, rail = wheel_top + highest_wheel_ * scale_;

    for (std::size_t i = row.first; i <= row.last; ++i) body(i, roof, floor);
    for (const Hinge& hinge : vehicle_.hinges) {
      const auto front = static_cast<std::size_t>(vehicle_.body_index(hinge.front_body));
      const auto rear = static_cast<std::size_t>(vehicle_.body_index(hinge.rear_body));
      if (front < row.first || rear > row.last) continue;
      canvas_.add(
          R"(<circle cx="{:.1f}" cy="{:.1f}" r="4.5" fill="#ffffff" stroke="{}" stroke-width="1.6"/>)",
          px(hinge.x), floor - 9, body_line);
    }
    canvas_.line(px(row.rear) - 12, rail + 1, px(row.front) + 12, rail + 1, rail_line, 2);
    for (std::size_t g = 0; g < vehicle_.gears.size(); ++g) {
      const RunningGear& gear = vehicle_.gears[g];
      if (!stands_in(gear, row)) continue;
      const bool is_again = number > 0 && stands_in(gear, rows_[number - 1]);
      draw_gear(gear, loads_.wheel_pairs[g], floor, rail, is_again);
    }
    return dimensions(row, number, rail);
  }

  void body(std::size_t i, double roof, double floor) {
    const CarBody& body = vehicle_.bodies[i];
    const Span span = span_of(body);
    const double gap = std::min(0.1 * scale_, 3.0);
    const double x1 = px(span.rear) + gap, x2 = px(span.front) - gap;
    // The outer ends of the vehicle have noses.
    const bool is_nose_front = i == 0, is_nose_rear = i + 1 == vehicle_.bodies.size();
    const double nose = std::min(0.9 * scale_, 0.2 * (x2 - x1)), corner = 4;
    const auto end = [&](bool is_nose) { return is_nose ? nose : corner; };
    const double f = end(is_nose_front), r = end(is_nose_rear), drop = 0.62 * (floor - roof);
    canvas_.add(
        R"(<path d="M{:.1f} {:.1f} H{:.1f} Q{:.1f} {:.1f} {:.1f} {:.1f} V{:.1f} H{:.1f} V{:.1f} Q{:.1f} {:.1f} {:.1f} {:.1f} Z" fill="{}" stroke="{}" stroke-width="1.3"/>)",
        x1 + r, roof, x2 - f, x2 - 0.15 * f, roof, x2, roof + (is_nose_front ? drop : corner), floor, x1,
        roof + (is_nose_rear ? drop : corner), x1 + 0.15 * r, roof, x1 + r, roof, body_fill, body_line);
    const double middle = (x1 + x2) / 2, height = floor - roof;
    canvas_.text(middle, roof + 0.34 * height, body.name, "middle", ink, 12, true);
    canvas_.text(middle, roof + 0.34 * height + 15, fmt::format("{:.2f} t", body.mass / 1e3));
    // centre of mass: a circle with two black quarters
    const double cx = px(body.x), cy = floor - 0.2 * height, rad = 5;
    canvas_.add(R"(<circle cx="{:.1f}" cy="{:.1f}" r="{:g}" fill="#ffffff" stroke="{}"/>)", cx, cy, rad, ink);
    canvas_.add(
        R"(<path d="M{0:.1f} {1:.1f} v-{2:g} a{2:g} {2:g} 0 0 1 {2:g} {2:g} z M{0:.1f} {1:.1f} v{2:g} a{2:g} {2:g} 0 0 1 -{2:g} -{2:g} z" fill="{3}"/>)",
        cx, cy, rad, ink);
  }

  void draw_gear(const RunningGear& gear, const std::vector<WheelPairLoad>& loads, double floor, double rail,
                 bool is_again) {
    const char* const dark = is_again ? pale : ink;
    double front = gear.x, rear = gear.x, highest = 0;
    for (const WheelPair& pair : gear.wheel_pairs) {
      front = std::max(front, pair.x.value);
      rear = std::min(rear, pair.x.value);
      highest = std::max(highest, pair.radius.value);
    }
    const double bar = std::max(0.16 * scale_, 4.0);
    const double frame_y = rail - (2 * highest * 0.5 + 0.28) * scale_ - bar;
    const double seat = gear.has_frame() ? frame_y + bar : floor;  // of the primary suspensions
    // wheels behind the frame
    for (const WheelPair& pair : gear.wheel_pairs) {
      const double cx = px(pair.x), r = pair.radius * scale_, cy = rail - r;
      canvas_.add(R"(<circle cx="{:.1f}" cy="{:.1f}" r="{:.1f}" fill="{}" stroke="{}" stroke-width="1.4"/>)",
                  cx, cy, r - 0.7, wheel_fill, dark);
      if (pair.resilient)
        canvas_.add(
            R"(<circle cx="{:.1f}" cy="{:.1f}" r="{:.1f}" fill="none" stroke="{}" stroke-width="1.6" stroke-dasharray="2 1.5"/>)",
            cx, cy, 0.72 * r, is_again ? pale : spring_line);
      canvas_.spring(cx, seat, cy, std::max(0.07 * scale_, 2.5), is_again ? pale : spring_line);
      canvas_.add(R"(<circle cx="{:.1f}" cy="{:.1f}" r="2" fill="{}"/>)", cx, cy, dark);
    }
    if (gear.has_frame())
      canvas_.add(R"(<rect x="{:.1f}" y="{:.1f}" width="{:.1f}" height="{:.1f}" rx="1.5" fill="{}"/>)",
                  px(rear) - 0.12 * scale_, frame_y, (front - rear + 0.24) * scale_, bar,
                  is_again ? pale : frame_fill);
    // secondaries: those at one place side by side
    for (std::size_t i = 0; i < gear.secondaries.size(); ++i) {
      int same = 0, rank = 0;
      for (std::size_t j = 0; j < gear.secondaries.size(); ++j)
        if (std::abs(gear.secondaries[j].x - gear.secondaries[i].x) < 0.05) {
          ++same;
          if (j < i) ++rank;
        }
      const double half = std::max(0.1 * scale_, 3.0);
      const double x = px(gear.secondaries[i].x) + (0.5 * (same - 1) - rank) * (2 * half + 3);
      canvas_.spring(x, floor, frame_y, half, is_again ? pale : spring_line);
    }
    if (is_again) return;
    // axle loads, an arrow of the rail on the wheel
    for (std::size_t w = 0; w < loads.size(); ++w) {
      const double x = px(gear.wheel_pairs[w].x);
      canvas_.line(x, rail + 20, x, rail + 8, frame_fill, 1.4);
      canvas_.add(R"(<path d="M{:.1f} {:.1f} l-3.5 8 h7 z" fill="{}"/>)", x, rail + 3, frame_fill);
      canvas_.text(x, rail + 32, fmt::format("{:.1f}", loads[w].axle_load / 1e3));
    }
  }

  /// Below the rail: wheelbases, distances of pivots, lengths; returns where the row ends.
  double dimensions(const Row& row, std::size_t number, double rail) {
    const double wheelbases = rail + 54, pivots = wheelbases + 20, lengths = pivots + 20,
                 overall = lengths + 20;
    const RunningGear* ahead = nullptr;  // the gear drawn last
    bool is_row_first = true;
    for (const RunningGear& gear : vehicle_.gears) {
      if (!stands_in(gear, row)) {
        if (!is_row_first) break;
        ahead = &gear;
        continue;
      }
      const bool is_again = number > 0 && stands_in(gear, rows_[number - 1]);
      if (!is_again && gear.wheel_pairs.size() > 1) {
        const auto [rear, front] =
            std::ranges::minmax(gear.wheel_pairs, {}, [](const WheelPair& pair) { return pair.x.value; });
        canvas_.dimension(px(rear.x), px(front.x), wheelbases, front.x - rear.x, rail + 38);
      }
      if (ahead && !is_row_first)
        canvas_.dimension(px(gear.pivot_x), px(ahead->pivot_x), pivots, ahead->pivot_x - gear.pivot_x,
                          wheelbases + 5);
      else if (ahead && !is_again)  // from the last gear of the row above
        open_dimension(px(gear.pivot_x), px(row.front), pivots, ahead->pivot_x - gear.pivot_x,
                       wheelbases + 5);
      ahead = &gear;
      is_row_first = false;
    }
    for (std::size_t i = row.first; i <= row.last; ++i) {
      const Span span = span_of(vehicle_.bodies[i]);
      canvas_.dimension(px(span.rear), px(span.front), lengths, span.front - span.rear, pivots + 6);
    }
    if (rows_.size() > 1 || vehicle_.bodies.size() == 1) return lengths + 22;
    canvas_.dimension(px(row.rear), px(row.front), overall, row.front - row.rear, lengths + 6);
    return overall + 22;
  }

  /// A distance whose front end is in the row above.
  void open_dimension(double x, double edge, double y, double metres, double lines_from) {
    canvas_.line(x, lines_from, x, y + 4, pale, 0.7);
    canvas_.line(x - 3, y + 3, x + 3, y - 3, soft_ink, 1);
    canvas_.line(x, y, edge + 10, y, soft_ink, 0.8);
    canvas_.add(R"(<path d="M{:.1f} {:.1f} l-6 -3 v6 z" fill="{}"/>)", edge + 14, y, soft_ink);
    canvas_.number_on_line((x + edge) / 2, y - 3, length_text(metres), "middle");
  }
};

}  // namespace

std::string draw_vehicle(const RailVehicle& vehicle, const DrawingOptions& options) {
  const std::string object = vehicle.label() + ", drawing";
  require(options.width >= 300, object, "width", options.width, "px", ">= 300");
  require_positive(object, "row length", options.row_length, "m");
  require_positive(object, "height of the bodies", options.body_height, "m");
  return Drawing(vehicle, options).svg();
}

void write_vehicle_drawing(const std::filesystem::path& path, const RailVehicle& vehicle,
                           const DrawingOptions& options) {
  const std::string svg = draw_vehicle(vehicle, options);
  results::PendingFile pending(path);
  std::ofstream file(pending.partial_path(), std::ios::binary);
  file << svg;
  file.close();
  if (!file) throw InputError(path.string() + ": cannot be written");
  pending.commit();
}

}  // namespace easydyn::vehicles

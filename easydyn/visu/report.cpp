#include "easydyn/visu/report.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <ctime>
#include <fstream>

#include "easydyn/error.hpp"
#include "easydyn/results/pending_file.hpp"
#include "easydyn/visu/html.hpp"
#include "easydyn/visu/number_text.hpp"
#include "easydyn/visu/svg.hpp"
#include "easydyn/visu/viewer_bundle.hpp"

namespace easydyn::visu {

namespace {

constexpr const char* minus_sign = "\u2212";

// Nothing but what the page holds may be loaded: the browser itself enforces it.
constexpr const char* content_policy =
    "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data:";

constexpr size_t curve_points_of_a_page = 300'000;   // 8 bytes each, 4/3 as base64: about 3 MB
constexpr size_t scene_numbers_of_a_page = 300'000;  // 4 bytes each: about 1.6 MB
constexpr size_t drawing_bytes_of_a_page = 1'000'000;

constexpr const char* stage = R"(<div class="frame"><div class="stage">
<div class="overlay"><span data-control="time"></span><span data-control="note"></span></div></div>
<p class="no-webgl">This browser offers no WebGL, so the animation cannot be drawn. Charts and tables are complete.</p>
<div class="controls">
<button type="button" data-control="play">Play</button>
<input type="range" min="0" max="1000" value="0" data-control="scrub" aria-label="time">
<label>Speed <select data-control="speed"></select></label>
<label data-control="exaggeration-label">Deflections <select data-control="exaggeration"></select></label>
<label data-control="follow-label"><input type="checkbox" data-control="follow"> Travel along</label>
<button type="button" data-control="side">Side view</button>
<button type="button" data-control="reset">Reset view</button>
</div></div>
<p class="caption screen">Drag to turn, turn the wheel to zoom, drag with the right button to shift.</p>
)";

/// A number, or a dash that stands for none: such cells are right-aligned.
bool is_numeric(const std::string& cell) {
  const bool has_digit = cell.find_first_of("0123456789") != cell.npos;
  std::string rest = cell;
  for (const std::string sign : {minus_sign, "\u2013", "\u00b7", "\u00d7", "\u00b1"})
    for (size_t at; (at = rest.find(sign)) != rest.npos;) rest.erase(at, sign.size());
  if (rest.find_first_not_of("0123456789+-.eE %/<>\u2013") != rest.npos) return false;
  return has_digit || rest.empty() || rest == "-";
}

/// The page while it is written: HTML text and, beside it, the data of charts and scenes.
class Page {
 public:
  Page(int points_per_curve, int times_per_scene)
      : points_per_curve_(points_per_curve), times_per_scene_(times_per_scene) {}

  void add(const std::string& text) { html_ += text; }

  void add_heading(int level, const std::string& text) {
    const int number = level == 2 ? ++section_ : ++subsection_;
    if (level == 2) {
      subsection_ = 0;
      html_ += fmt::format("<h2 id=\"section-{0}\">{0} {1}</h2>\n", number, html::inline_text(text));
      contents_ += fmt::format("<li><a href=\"#section-{}\">{}</a></li>\n", number, html::inline_text(text));
    } else if (section_ > 0) {
      html_ += fmt::format("<h3>{}.{} {}</h3>\n", section_, number, html::inline_text(text));
    } else {
      html_ += fmt::format("<h3>{}</h3>\n", html::inline_text(text));
    }
  }

  void add_key_figures(const std::vector<KeyFigure>& figures) {
    html_ += "<div class=\"figures\">\n";
    for (const KeyFigure& f : figures)
      html_ += fmt::format(
          "<div><div class=\"name\">{}</div><div class=\"value\">{} <span class=\"unit\">{}</span></div>"
          "<div class=\"remark\">{}</div></div>\n",
          html::inline_text(f.name), html::escaped(f.value), html::escaped(f.unit),
          html::inline_text(f.remark));
    html_ += "</div>\n";
  }

  void add_charts(const std::vector<Chart>& charts) {
    if (charts.size() > 1) html_ += "<div class=\"charts\">\n";
    for (const Chart& chart : charts) {
      html_ += fmt::format("<figure data-chart=\"{}\">\n", chart_count_++);
      add_figure_title(chart.title);
      html_ += "<div class=\"plot\"></div>\n";
      add_caption(chart.caption);
      html_ += "</figure>\n";
      charts_ += (charts_.empty() ? "" : ",\n") + to_json(chart, points_per_curve_);
    }
    if (charts.size() > 1) html_ += "</div>\n";
  }

  void add_animation(const Scene& scene, const std::string& caption) {
    html_ += fmt::format("<figure class=\"animation\" data-scene=\"{}\">\n", scene_count_++);
    add_figure_title(scene.name);
    html_ += stage;
    add_caption(caption);
    html_ += "</figure>\n";
    scenes_ += (scenes_.empty() ? "" : ",\n") + to_json(scene, times_per_scene_);
  }

  void add_drawing(const std::string& text, const std::string& caption) {
    const svg::Drawing drawing = svg::read(text, drawing_bytes_of_a_page - drawing_bytes_);
    drawing_bytes_ += text.size();
    html_ += "<figure class=\"drawing\">\n";
    add_figure_title(drawing.title);
    html_ += fmt::format("<div class=\"scroll\">{}</div>\n", drawing.markup);
    add_caption(caption);
    html_ += "</figure>\n";
  }

  void add_table(const Table& table) {
    std::vector<bool> right(table.header.size(), !table.rows.empty());
    for (const auto& row : table.rows) {
      if (row.size() != table.header.size())
        throw ModelError(fmt::format("table \"{}\": a row of {} cells under {} headings", table.caption,
                                     row.size(), table.header.size()));
      for (size_t c = 0; c < row.size(); ++c) right[c] = right[c] && is_numeric(row[c]);
    }
    const std::string heading = table.caption.empty()
                                    ? ""
                                    : fmt::format("<span class=\"number\">Table {}</span> {}", ++table_,
                                                  html::inline_text(table.caption));
    if (table.is_folded)
      html_ += fmt::format(
          "<details><summary class=\"heading\">{}<span class=\"screen\"> ({} rows)</span></summary>\n",
          heading, table.rows.size());
    else if (!heading.empty())
      html_ += fmt::format("<p class=\"heading\">{}</p>\n", heading);
    html_ += "<div class=\"scroll\"><table class=\"data\"><thead><tr>";
    for (size_t c = 0; c < right.size(); ++c)
      html_ += fmt::format("<th{}>{}</th>", right[c] ? " class=\"right\"" : "",
                           html::inline_text(table.header[c]));
    html_ += "</tr></thead><tbody>\n";
    for (const auto& row : table.rows) {
      html_ += "<tr>";
      for (size_t c = 0; c < right.size(); ++c)
        html_ += fmt::format("<td{}>{}</td>", right[c] ? " class=\"right\"" : "", html::inline_text(row[c]));
      html_ += "</tr>\n";
    }
    html_ += table.is_folded ? "</tbody></table></div></details>\n" : "</tbody></table></div>\n";
  }

  void add_parameters(const std::vector<Parameter>& parameters) {
    html_ +=
        "<div class=\"scroll\"><table class=\"data parameters\"><thead><tr><th>Parameter</th><th "
        "class=\"right\">Value</th>"
        "<th>Unit</th><th>Source</th></tr></thead><tbody>\n";
    const std::string* group = nullptr;
    for (const Parameter& p : parameters) {
      if ((!group || *group != p.group) && !p.group.empty())
        html_ +=
            fmt::format("<tr class=\"group\"><td colspan=\"4\">{}</td></tr>\n", html::inline_text(p.group));
      group = &p.group;
      html_ += fmt::format(
          "<tr><td>{}</td><td class=\"right\">{}</td><td>{}</td><td class=\"source\">{}</td></tr>\n",
          html::inline_text(p.name), short_number_text(p.value), html::escaped(p.unit == "1" ? "" : p.unit),
          html::inline_text(p.source));
    }
    html_ += "</tbody></table></div>\n";
  }

  std::string document(const std::string& title, const std::string& subtitle) const {
    const std::string created = fmt::format("{:%Y-%m-%d %H:%M} UTC", fmt::gmtime(std::time(nullptr)));
    std::string out = fmt::format(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
        "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
        "<meta http-equiv=\"Content-Security-Policy\" content=\"{}\">\n"
        "<meta name=\"generator\" content=\"EasyDyn {}\">\n<link rel=\"icon\" href=\"data:,\">\n"
        "<title>{}</title>\n<style>\n{}</style>\n</head>\n<body>\n<div class=\"page\">\n",
        content_policy, EASYDYN_VERSION, html::escaped(title), viewer_css);
    out += fmt::format("<header class=\"title\"><h1>{}</h1><p>{}</p></header>\n", html::inline_text(title),
                       html::inline_text(subtitle));
    out +=
        "<noscript><p class=\"note\">Charts and animation need JavaScript; texts and tables do "
        "not.</p></noscript>\n";
    if (section_ > 3) out += fmt::format("<nav class=\"contents\"><ol>\n{}</ol></nav>\n", contents_);
    out += fmt::format("<main>\n{}</main>\n", html_);
    out += fmt::format("<footer>Page written by EasyDyn {} on {}.", EASYDYN_VERSION, created);
    if (chart_count_ > 0)
      out += fmt::format(
          " Curves longer than {} points are thinned for display; their extremes are kept."
          "<span class=\"screen\"> Drag over a chart to zoom, double-click to reset.</span>",
          points_per_curve_);
    out += "</footer>\n</div>\n";
    const std::string data = fmt::format("{{\"charts\":[{}],\n\"scenes\":[{}]}}", charts_, scenes_);
    out += fmt::format("<script type=\"application/json\" id=\"page-data\">{}</script>\n<script>\n",
                       html::inside_script(data));
    out += viewer_js;
    out += "</script>\n</body>\n</html>\n";
    return out;
  }

 private:
  void add_figure_title(const std::string& title) {
    html_ += fmt::format("<p class=\"heading\"><span class=\"number\">Figure {}</span> {}</p>\n", ++figure_,
                         html::inline_text(title));
  }
  void add_caption(const std::string& caption) {
    if (!caption.empty()) html_ += fmt::format("<p class=\"caption\">{}</p>\n", html::inline_text(caption));
  }

  int points_per_curve_, times_per_scene_;
  int section_ = 0, subsection_ = 0, figure_ = 0, table_ = 0, chart_count_ = 0, scene_count_ = 0;
  size_t drawing_bytes_ = 0;
  std::string html_, contents_, charts_, scenes_;
};

template <class... Ts>
struct Overloaded : Ts... {
  using Ts::operator()...;
};
template <class... Ts>
Overloaded(Ts...) -> Overloaded<Ts...>;

}  // namespace

Report::Report(std::string title, std::string subtitle)
    : title_(std::move(title)), subtitle_(std::move(subtitle)) {}

Report& Report::add_facts(std::vector<std::pair<std::string, std::string>> facts) {
  blocks_.push_back(Facts{std::move(facts)});
  return *this;
}

Report& Report::add_section(std::string title) {
  blocks_.push_back(Heading{2, std::move(title)});
  return *this;
}

Report& Report::add_subsection(std::string title) {
  blocks_.push_back(Heading{3, std::move(title)});
  return *this;
}

Report& Report::add_paragraph(std::string text) {
  blocks_.push_back(Paragraph{std::move(text)});
  return *this;
}

Report& Report::add_list(std::vector<std::string> items) {
  blocks_.push_back(List{std::move(items)});
  return *this;
}

Report& Report::add_note(std::string text) {
  blocks_.push_back(Note{std::move(text)});
  return *this;
}

Report& Report::add_key_figures(std::vector<KeyFigure> figures) {
  blocks_.push_back(std::move(figures));
  return *this;
}

Report& Report::add_chart(Chart chart) {
  return add_charts({std::move(chart)});
}

Report& Report::add_charts(std::vector<Chart> charts) {
  blocks_.push_back(std::move(charts));
  return *this;
}

Report& Report::add_table(Table table) {
  blocks_.push_back(std::move(table));
  return *this;
}

Report& Report::add_parameters(std::vector<Parameter> parameters) {
  blocks_.push_back(std::move(parameters));
  return *this;
}

Report& Report::add_text(std::string title, std::string text) {
  blocks_.push_back(Verbatim{std::move(title), std::move(text)});
  return *this;
}

Report& Report::add_animation(Scene scene, std::string caption) {
  blocks_.push_back(Animation{std::move(scene), std::move(caption)});
  return *this;
}

Report& Report::add_drawing(std::string svg, std::string caption) {
  blocks_.push_back(Drawing{std::move(svg), std::move(caption)});
  return *this;
}

std::string Report::html() const {
  // share the page's size among its curves and scenes
  size_t curves = 1, numbers_per_time = 1;
  for (const Block& block : blocks_) {
    if (const auto* charts = std::get_if<std::vector<Chart>>(&block))
      for (const Chart& chart : *charts) curves += chart.series.size() + 2 * chart.bands.size();
    if (const auto* animation = std::get_if<Animation>(&block)) {
      numbers_per_time += 7 * animation->scene.frames.size();
      for (const DeformingLine& line : animation->scene.lines) numbers_per_time += size_t(line.x.size());
    }
  }
  const int points = int(std::clamp<size_t>(curve_points_of_a_page / curves, 200, 4000));
  const int times = int(std::clamp<size_t>(scene_numbers_of_a_page / numbers_per_time, 100, 600));

  Page page(points, times);
  for (const Block& block : blocks_) {
    std::visit(
        Overloaded{
            [&](const Facts& b) {
              page.add("<dl class=\"facts\">\n");
              for (const auto& [name, text] : b.facts)
                page.add(fmt::format("<dt>{}</dt><dd>{}</dd>\n", html::inline_text(name),
                                     html::inline_text(text)));
              page.add("</dl>\n");
            },
            [&](const Heading& b) { page.add_heading(b.level, b.text); },
            [&](const Paragraph& b) { page.add(fmt::format("<p>{}</p>\n", html::inline_text(b.text))); },
            [&](const List& b) {
              page.add("<ul>\n");
              for (const auto& item : b.items)
                page.add(fmt::format("<li>{}</li>\n", html::inline_text(item)));
              page.add("</ul>\n");
            },
            [&](const Note& b) {
              page.add(fmt::format("<div class=\"note\"><p>{}</p></div>\n", html::inline_text(b.text)));
            },
            [&](const Verbatim& b) {
              page.add(fmt::format("<p class=\"heading\">{}</p>\n<pre>{}</pre>\n", html::inline_text(b.title),
                                   html::escaped(b.text)));
            },
            [&](const std::vector<KeyFigure>& b) { page.add_key_figures(b); },
            [&](const std::vector<Chart>& b) { page.add_charts(b); },
            [&](const Table& b) { page.add_table(b); },
            [&](const std::vector<Parameter>& b) { page.add_parameters(b); },
            [&](const Animation& b) { page.add_animation(b.scene, b.caption); },
            [&](const Drawing& b) { page.add_drawing(b.svg, b.caption); },
        },
        block);
  }
  return page.document(title_, subtitle_);
}

void Report::write(const std::filesystem::path& path) const {
  const std::string text = html();
  results::PendingFile pending(path);
  std::ofstream file(pending.partial_path(), std::ios::binary);
  file << text;
  file.close();
  if (!file) throw InputError(fmt::format("{}: cannot be written", path.string()));
  pending.commit();
}

void write_animation_page(const std::filesystem::path& path, const std::string& title, const Scene& scene,
                          const std::vector<Chart>& charts, const std::string& text) {
  Report report(title);
  if (!text.empty()) report.add_paragraph(text);
  report.add_animation(scene);
  if (!charts.empty()) report.add_charts(charts);
  report.write(path);
}

}  // namespace easydyn::visu

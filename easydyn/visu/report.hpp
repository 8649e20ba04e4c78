#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "easydyn/parameter.hpp"
#include "easydyn/visu/chart.hpp"
#include "easydyn/visu/scene.hpp"

namespace easydyn::visu {

/// Columns whose name or cells are numbers are right-aligned by the page itself.
struct Table {
  std::vector<std::string> header;  ///< with units, e.g. "PPV [mm/s]"
  std::vector<std::vector<std::string>> rows;
  std::string caption = {};
  bool is_folded = false;  ///< only its caption is shown until the reader opens it; paper has all of it
};

/// One number that matters, shown large. `remark` says what it is measured against.
struct KeyFigure {
  std::string name, value, unit;
  std::string remark = {};
};

/// One self-contained HTML page: it opens offline and asks no server for anything. Text is plain; words
/// between `backticks` are set as code. Blocks appear in the order in which they were added.
///
///   Report report("Double pendulum", "free motion from rest");
///   report.add_section("Motion").add_paragraph("Two rods of 1 m.").add_charts({angle, energy});
///   report.add_animation(scene);
///   report.write("pendulum.html");
class Report {
 public:
  explicit Report(std::string title, std::string subtitle = "");

  Report& add_facts(
      std::vector<std::pair<std::string, std::string>> facts);  ///< who, when, how: name and text
  Report& add_section(std::string title);
  Report& add_subsection(std::string title);
  Report& add_paragraph(std::string text);
  Report& add_list(std::vector<std::string> items);
  Report& add_note(std::string text);  ///< set apart: a warning or a limit of validity
  Report& add_key_figures(std::vector<KeyFigure> figures);
  Report& add_chart(Chart chart);                 ///< over the full width
  Report& add_charts(std::vector<Chart> charts);  ///< side by side where there is room
  Report& add_table(Table table);
  Report& add_parameters(std::vector<Parameter> parameters);  ///< with their sources, in groups of one name
  Report& add_text(std::string title, std::string text);      ///< verbatim, e.g. an input file
  Report& add_animation(Scene scene, std::string caption = "");
  /// An SVG image over the full width, titled by its `<title>`: lines, shapes and text, with a viewBox, nothing that
  /// runs or loads; all drawings of a page together at most 1 MB.
  Report& add_drawing(std::string svg, std::string caption = "");

  /// The page. Curves are thinned so that it stays below about 5 MB.
  /// @throws ModelError if a chart, a table, a drawing or a scene is not sound
  std::string html() const;

  /// Writes the page under a temporary name and renames it when complete.
  /// @throws InputError if the file cannot be written
  void write(const std::filesystem::path& path) const;

 private:
  struct Facts {
    std::vector<std::pair<std::string, std::string>> facts;
  };
  struct Heading {
    int level;
    std::string text;
  };
  struct Paragraph {
    std::string text;
  };
  struct List {
    std::vector<std::string> items;
  };
  struct Note {
    std::string text;
  };
  struct Verbatim {
    std::string title, text;
  };
  struct Animation {
    Scene scene;
    std::string caption;
  };
  struct Drawing {
    std::string svg, caption;
  };
  using Block = std::variant<Facts, Heading, Paragraph, List, Note, std::vector<KeyFigure>,
                             std::vector<Chart>, Table, std::vector<Parameter>, Verbatim, Animation, Drawing>;

  std::string title_, subtitle_;
  std::vector<Block> blocks_;
};

/// A page with one animation and, below it, charts: what a small example shows of its motion.
/// @throws ModelError, InputError as Report
void write_animation_page(const std::filesystem::path& path, const std::string& title, const Scene& scene,
                          const std::vector<Chart>& charts = {}, const std::string& text = "");

}  // namespace easydyn::visu

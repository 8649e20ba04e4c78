#include <fmt/format.h>
#include <fmt/ranges.h>

#include "easydyn/error.hpp"
#include "easydyn/visu/json.hpp"
#include "soil/report/compliance_charts.hpp"
#include "soil/report/sections.hpp"
#include "soil/report/text.hpp"

namespace easydyn::soil::report {

void add_foundation(visu::Report& report, const results::ResultReader& track) {
  const std::string folder = "/foundation/fit/";
  if (!track.has(folder + "frequency")) return;
  ComplianceFit fit;
  fit.frequency = track.read_vector(folder + "frequency");
  const auto read = [&](const char* name) {
    const Eigen::MatrixXd parts = track.read_matrix(folder + name);
    if (parts.rows() != fit.frequency.size() || parts.cols() != 2)
      throw InputError(fmt::format("{}: \"{}{}\" has the shape ({} x {}), must be ({} x 2)",
                                   track.path().string(), folder, name, parts.rows(), parts.cols(),
                                   fit.frequency.size()));
    Eigen::VectorXcd values(parts.rows());
    values.real() = parts.col(0);
    values.imag() = parts.col(1);
    return values;
  };
  fit.ground_00 = read("ground_00");
  fit.ground_01 = read("ground_01");
  fit.model_00 = read("model_00");
  fit.model_01 = read("model_01");

  report.add_subsection("The foundation against the ground that it stands for");
  const std::string source = track.path().string() + ":" + folder + "quality";
  const visu::json::Value quality = visu::json::parse(track.read_text(folder + "quality"), source);
  try {
    const auto number = [&](const char* name) { return quality.at(name).number(); };
    std::vector<std::string> bounds;
    for (const auto& bound : quality.at("bounds").array()) bounds.push_back(bound.string());
    std::string fitted = quality.at("source").string();
    if (fitted.starts_with("C: ")) fitted.replace(0, 4, "F");  // "C: fit to" without its mark
    report.add_paragraph(
        fmt::format("{}. What is left is what five constants cannot follow. Over the band the error (rms) is "
                    "{} % under the loaded footprint and "
                    "{} % at the next one, of |H_00| at the lowest frequency. Margins of passivity: "
                    "(k_f + 4 k_c) / k_f = {}, (d_f + 4 d_c) / d_f = {}; m_f = {} kg, must be at least 0. {}",
                    fitted, number_text(100 * number("rms_00"), 2), number_text(100 * number("rms_01"), 2),
                    number_text(number("stiffness_margin"), 3), number_text(number("damping_margin"), 2),
                    number_text(number("mass"), 3),
                    bounds.empty() ? "The fit lies on no bound."
                                   : fmt::format("The fit lies on {}.", fmt::join(bounds, " and "))));
  } catch (const Error& error) {
    throw InputError(fmt::format("{}: {}", source, error.what()));
  }
  report.add_charts(draw_compliances(fit));
}

}  // namespace easydyn::soil::report

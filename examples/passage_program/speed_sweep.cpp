// Several speeds in one call: a table and charts of step 1.

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <mutex>
#include <thread>

#include "easydyn/visu/report.hpp"
#include "examples/passage_program/passage_run.hpp"

namespace easydyn::examples {

using namespace easydyn::units;
namespace fs = std::filesystem;

int run_speed_sweep(const PassageProgram& program, const PassageProgramOptions& options) {
  fs::create_directories(options.output);
  const std::size_t n = options.speeds.size();
  std::vector<std::vector<track::SummaryFigure>> summaries(n);
  std::vector<std::string> failures(n);
  std::vector<std::vector<std::string>> warnings(n);
  std::atomic<std::size_t> next = 0;
  std::mutex printing;
  const auto work = [&] {
    for (std::size_t i = next++; i < n; i = next++) {
      try {
        PassageRun run(program, options, options.speeds[i] * km / h);
        run.compute();
        summaries[i] = run.summarise();
        warnings[i] = run.warn();
        for (const std::string& warning : run.passage.warnings) warnings[i].push_back(warning);
      } catch (const std::exception& e) {
        failures[i] = e.what();
        warnings[i].push_back(std::string("failed: ") + e.what());
      }
      const std::scoped_lock lock(printing);
      fmt::print("{}: {:g} km/h {}\n", program.name, options.speeds[i],
                 failures[i].empty() ? "done" : "failed: " + failures[i]);
    }
  };
  std::vector<std::thread> threads;
  for (unsigned i = 0; i < std::clamp(std::thread::hardware_concurrency(), 1u, unsigned(n)); ++i)
    threads.emplace_back(work);
  for (std::thread& thread : threads) thread.join();
  const auto first = std::ranges::find_if(summaries, [](const auto& list) { return !list.empty(); });
  if (first == summaries.end()) throw SolverError("sweep: " + failures[0]);

  // Table, chart, warnings.
  const std::vector<std::size_t> shown = {2, 3, 4, 5, 6, 7, 8};  // of the summary: not the weights
  visu::Table table{{"speed [km/h]"}, {}, "Speeds"};
  for (const std::size_t k : shown) {
    const track::SummaryFigure& f = (*first)[k];
    table.header.push_back(f.unit.empty() ? f.name : fmt::format("{} [{}]", f.name, f.unit));
  }
  Eigen::VectorXd speeds = Eigen::VectorXd::Map(options.speeds.data(), static_cast<Eigen::Index>(n));
  std::vector<visu::Chart> charts;
  for (const std::size_t k : shown) {
    Eigen::VectorXd values(speeds.size());
    for (std::size_t i = 0; i < n; ++i)
      values[static_cast<Eigen::Index>(i)] = summaries[i].empty() ? std::nan("") : summaries[i][k].value;
    const track::SummaryFigure& f = (*first)[k];
    if (values.isZero(0)) continue;  // no contact is lost
    const std::string quantity = f.unit == "kN"   ? "force"
                                 : f.unit == "mm" ? "deflection"
                                 : f.unit == "ms" ? "time"
                                                  : "number";
    charts.push_back({.title = f.name,
                      .x = {"speed", "km/h"},
                      .y = {quantity, f.unit.empty() ? "1" : f.unit},
                      .series = {{f.name, speeds, values, visu::Stroke::line_and_points}}});
  }
  for (std::size_t i = 0; i < n; ++i) {
    std::vector<std::string> row = {fmt::format("{:g}", options.speeds[i])};
    for (const std::size_t k : shown)
      row.push_back(summaries[i].empty() ? "failed" : fmt::format("{:.4g}", summaries[i][k].value));
    table.rows.push_back(row);
  }
  visu::Report report(program.title, fmt::format("{} speeds, step 1 of a prediction: train and track", n));
  report.add_paragraph(fmt::format("{} on {}, foundation {}. The ground is computed for one speed at a time.",
                                   program.vehicle.label(), program.track.label(), options.foundation));
  for (std::size_t i = 0; i < n; ++i)
    for (const std::string& warning : warnings[i])
      report.add_note(fmt::format("{:g} km/h: {}", options.speeds[i], warning));
  report.add_section("Results").add_table(table).add_charts(charts);
  report.write(options.output / "sweep.html");

  for (const std::string& name : table.header)
    fmt::print("{}{}", name, &name == &table.header.back() ? "\n" : "; ");
  for (const auto& row : table.rows)
    for (std::size_t c = 0; c < row.size(); ++c)
      fmt::print("{:>8}{}", row[c], c + 1 == row.size() ? "\n" : " ");
  for (std::size_t i = 0; i < n; ++i)
    for (const std::string& warning : warnings[i])
      fmt::print("{}: warning: {:g} km/h: {}\n", program.name, options.speeds[i], warning);
  fmt::print("{}: wrote {}\n", program.name, (options.output / "sweep.html").string());
  return std::ranges::all_of(failures, &std::string::empty) ? 0 : 1;
}

}  // namespace easydyn::examples

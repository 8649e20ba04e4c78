#include "easydyn/sim/state_file.hpp"

#include <fmt/format.h>

#include <charconv>
#include <fstream>
#include <sstream>

#include "easydyn/error.hpp"
#include "easydyn/results/pending_file.hpp"

namespace easydyn {

namespace {

constexpr const char* title = "easydyn-state 1";

// Reads line by line; every complaint names file and line.
class Reader {
 public:
  explicit Reader(const std::filesystem::path& path) : path_(path), file_(path) {
    if (!file_) throw InputError(fmt::format("{}: cannot be read", path.string()));
  }

  /// Next line, which must start with the word; the rest of it is read by number() and name().
  void expect(const std::string& word) {
    std::string line;
    ++line_;
    if (!std::getline(file_, line)) fail(fmt::format("the file ends before \"{}\": is it complete?", word));
    const bool is_whole = word.empty() || word.back() == ' ' || line == word;
    if (line.compare(0, word.size(), word) != 0 || !is_whole)
      fail(fmt::format("\"{}\" expected, not \"{}\"", word, line));
    rest_ = std::istringstream(line.substr(word.size()));
  }
  double number() {
    std::string text;
    rest_ >> text;
    const char *begin = text.data(), *const end = begin + text.size();
    const bool is_negative = begin != end && *begin == '-';
    if (is_negative) ++begin;
    double value = 0;
    if (!text.starts_with(is_negative ? "-0x" : "0x")) fail(fmt::format("\"{}\" is not a number", text));
    const auto [last, error] = std::from_chars(begin + 2, end, value, std::chars_format::hex);
    if (error != std::errc() || last != end) fail(fmt::format("\"{}\" is not a number", text));
    return is_negative ? -value : value;
  }
  void expect_name(const std::string& name) {
    std::string text;
    std::getline(rest_ >> std::ws, text);
    if (text != name) fail(fmt::format("\"{}\" where the system has \"{}\"", text, name));
  }
  void expect_count(int count) {
    int found = -1;
    rest_ >> found;
    if (found != count) fail(fmt::format("{} where the system has {}", found, count));
  }
  int one_of(int a, int b) {
    int found = -1;
    rest_ >> found;
    if (found != a && found != b) fail(fmt::format("{} where the system has {}", found, b));
    return found;
  }
  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(fmt::format("{}:{}: {}", path_.string(), line_, what));
  }

 private:
  std::filesystem::path path_;
  std::ifstream file_;
  std::istringstream rest_;
  int line_ = 0;
};

}  // namespace

void write_state(const std::filesystem::path& path, System& system, const State& state) {
  system.evaluate(state);  // refuses a state of another system
  std::string text = fmt::format("{}\nsystem {}\ntime {:a}\n", title, system.name(), state.t);
  text += fmt::format("coordinates {}\n", system.size());
  for (int i = 0; i < system.size(); ++i)
    text += fmt::format("q {:a} {:a} {:a} {}\n", state.q[i], state.qd[i], state.qdd[i],
                        system.coordinate_name(i));
  text += fmt::format("first-order states {}\n", system.first_order_size());
  for (int i = 0; i < system.first_order_size(); ++i)
    text += fmt::format("x {:a} {:a} {}\n", state.x[i], state.xd[i],
                        system.equation_name(system.body_size() + i));
  text += fmt::format("velocity constraints {}\n", system.constraint_size());
  for (int i = 0; i < system.constraint_size(); ++i)
    text += fmt::format("lambda {:a} {}\n", state.lambda[i],
                        system.velocity_constraints()[static_cast<std::size_t>(i)].name());
  text += fmt::format("charts {}\n", state.charts.size());
  for (const Eigen::Matrix3d& R : state.charts) {
    text += "R";
    for (Eigen::Index i = 0; i < 9; ++i) text += fmt::format(" {:a}", R(i / 3, i % 3));
    text += "\n";
  }
  const auto write_numbers = [&text](const char* word, const Eigen::VectorXd& v) {
    text += fmt::format("{} {}", word, v.size());
    for (const double number : v) text += fmt::format(" {:a}", number);
    text += "\n";
  };
  write_numbers("loops", state.loops);
  write_numbers("pseudo accelerations", state.a);
  write_numbers("pseudo rates", state.w);
  text += fmt::format("inputs {}\n", system.input_size());
  for (int i = 0; i < system.input_size(); ++i)
    text += fmt::format("u {:a} {}\n", system.input_value(i), system.input_name(i));
  text += "end\n";

  results::PendingFile pending(path);
  std::ofstream file(pending.partial_path());
  file << text;
  file.close();
  if (!file) throw InputError(fmt::format("{}: cannot be written", path.string()));
  pending.commit();
}

State read_state(const std::filesystem::path& path, System& system) {
  Reader in(path);
  in.expect(title);
  in.expect("system ");
  in.expect_name(system.name());
  State state = system.initial_state();
  in.expect("time ");
  state.t = in.number();
  in.expect("coordinates ");
  in.expect_count(system.size());
  for (int i = 0; i < system.size(); ++i) {
    in.expect("q ");
    state.q[i] = in.number();
    state.qd[i] = in.number();
    state.qdd[i] = in.number();
    in.expect_name(system.coordinate_name(i));
  }
  in.expect("first-order states ");
  in.expect_count(system.first_order_size());
  for (int i = 0; i < system.first_order_size(); ++i) {
    in.expect("x ");
    state.x[i] = in.number();
    state.xd[i] = in.number();
    in.expect_name(system.equation_name(system.body_size() + i));
  }
  in.expect("velocity constraints ");
  in.expect_count(system.constraint_size());
  for (int i = 0; i < system.constraint_size(); ++i) {
    in.expect("lambda ");
    state.lambda[i] = in.number();
    in.expect_name(system.velocity_constraints()[static_cast<std::size_t>(i)].name());
  }
  in.expect("charts ");
  in.expect_count(static_cast<int>(state.charts.size()));
  for (Eigen::Matrix3d& R : state.charts) {
    in.expect("R ");
    for (Eigen::Index i = 0; i < 9; ++i) R(i / 3, i % 3) = in.number();
  }
  in.expect("loops ");
  in.expect_count(static_cast<int>(state.loops.size()));
  for (double& number : state.loops) number = in.number();
  in.expect("pseudo accelerations ");
  state.a.resize(in.one_of(0, system.size()));
  for (double& number : state.a) number = in.number();
  in.expect("pseudo rates ");
  state.w.resize(in.one_of(0, system.first_order_size()));
  for (double& number : state.w) number = in.number();
  in.expect("inputs ");
  in.expect_count(system.input_size());
  std::vector<double> inputs;
  for (int i = 0; i < system.input_size(); ++i) {
    in.expect("u ");
    inputs.push_back(in.number());
    in.expect_name(system.input_name(i));
  }
  in.expect("end");
  for (int i = 0; i < system.input_size(); ++i) system.set_input(i, inputs[static_cast<std::size_t>(i)]);
  return state;
}

}  // namespace easydyn

#include "soil/agreement.hpp"

#include <cstdint>
#include <exception>
#include <string>

#include "easydyn/error.hpp"

namespace easydyn::soil {
namespace {

enum class Kind : std::int32_t { none, model, input, solver };

struct Failure {
  Kind kind = Kind::none;
  std::string message;
};

Failure find_failure(const std::function<void()>& act) {
  try {
    act();
    return {};
  } catch (const ModelError& error) {
    return {Kind::model, error.what()};
  } catch (const SolverError& error) {
    return {Kind::solver, error.what()};
  } catch (const std::exception& error) {
    return {Kind::input, error.what()};
  }
}

}  // namespace

void act_together(Ranks* ranks, const std::function<void()>& act) {
  if (!ranks) return act();
  Failure failure = find_failure(act);
  double first = failure.kind == Kind::none ? 0 : ranks->size() - ranks->rank();
  ranks->maximise(&first, 1);
  if (first == 0) return;
  const int from = ranks->size() - static_cast<int>(first);
  auto length = static_cast<std::uint64_t>(failure.message.size());
  ranks->broadcast(&length, sizeof length, from);
  ranks->broadcast(&failure.kind, sizeof failure.kind, from);
  failure.message.resize(length);
  ranks->broadcast(failure.message.data(), length, from);
  switch (failure.kind) {
    case Kind::model:
      throw ModelError(failure.message);
    case Kind::solver:
      throw SolverError(failure.message);
    default:
      throw InputError(failure.message);
  }
}

void act_on_first(Ranks* ranks, const std::function<void()>& act) {
  act_together(ranks, [&] {
    if (!ranks || ranks->rank() == 0) act();
  });
}

}  // namespace easydyn::soil

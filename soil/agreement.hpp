#pragma once

#include <functional>

#include "soil/ranks.hpp"

namespace easydyn::soil {

/// Does on every rank what may fail on some of them (reading and writing files, say); all ranks call it.
/// @throws what `act` throws if there is one rank (nullptr); else, on all ranks, a ModelError, InputError or
///         SolverError with the message of the lowest rank whose `act` failed
void act_together(Ranks* ranks, const std::function<void()>& act);

/// The same with an `act` for the first rank only.
void act_on_first(Ranks* ranks, const std::function<void()>& act);

}  // namespace easydyn::soil

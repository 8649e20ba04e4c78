#pragma once

/// The multibody kernel in one include.
#include "easydyn/error.hpp"
#include "easydyn/forces/spring_damper.hpp"
#include "easydyn/forces/vertical_spring_damper.hpp"
#include "easydyn/math/units.hpp"
#include "easydyn/mbs/system.hpp"
#include "easydyn/sim/accelerations.hpp"
#include "easydyn/sim/adaptive_integrator.hpp"
#include "easydyn/sim/implicit_stepper.hpp"
#include "easydyn/sim/integrator.hpp"
#include "easydyn/sim/linearization.hpp"
#include "easydyn/sim/modes.hpp"
#include "easydyn/sim/recorder.hpp"
#include "easydyn/sim/state_space.hpp"
#include "easydyn/sim/static_equilibrium.hpp"

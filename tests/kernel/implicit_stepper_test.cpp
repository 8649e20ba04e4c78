#include "easydyn/sim/implicit_stepper.hpp"

#include <gmock/gmock.h>

#include "easydyn/easydyn.hpp"

namespace easydyn {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

/// A pendulum of length 1 m that swings wide.
class Pendulum : public System {
 public:
  Coordinate a = coordinate("a", 2.0);
  Body& bob = body("bob", 1.0);

 protected:
  void positions() override { bob = rotate_y(a) * translate(0, 0, -1); }
  void forces() override { gravity(); }
};

double angle_after_a_second(const std::function<double(Pendulum&)>& run) {
  Pendulum pendulum;
  return run(pendulum);
}

TEST(GeneralizedAlpha, IsOfSecondOrderForEverySpectralRadius) {
  const double exact = angle_after_a_second([](Pendulum& p) {
    Newmark fine(p, {.step = 1e-5, .newton_tolerance = 1e-12});
    fine.advance(1);
    return fine.state().q[0];
  });
  for (const double rho : {0.0, 0.5, 0.9, 1.0}) {
    const auto error = [&](double h) {
      return angle_after_a_second([&](Pendulum& p) {
               GeneralizedAlpha stepper(p, {.step = h}, rho);
               stepper.advance(1);
               return stepper.state().q[0];
             }) -
             exact;
    };
    EXPECT_NEAR(std::log2(error(4e-3) / error(2e-3)), 2, 0.1) << "rho " << rho;
  }
  for (const double alpha : {-1.0 / 3, -0.1, 0.0}) {
    const auto error = [&](double h) {
      return angle_after_a_second([&](Pendulum& p) {
               Hht stepper(p, {.step = h}, alpha);
               stepper.advance(1);
               return stepper.state().q[0];
             }) -
             exact;
    };
    EXPECT_NEAR(std::log2(error(4e-3) / error(2e-3)), 2, 0.1) << "alpha " << alpha;
  }
}

/// A mass on so stiff a spring that a step holds hundreds of its periods.
class Stiff : public System {
 public:
  Coordinate x = coordinate("x", 1.0);
  Body& mass = body("mass", 1.0);

 protected:
  void positions() override { mass = translate(x, 0, 0); }
  void forces() override { mass.add_force({-1e10 * x.value(), 0, 0}, mass.position()); }
};

TEST(GeneralizedAlpha, DampsTheUnresolvedByItsSpectralRadius) {
  for (const double rho : {0.3, 0.8, 1.0}) {
    Stiff stiff;
    GeneralizedAlpha stepper(stiff, {.step = 1e-2}, rho);
    for (int i = 0; i < 40; ++i) stepper.step();  // the smaller roots have gone
    const double before = std::abs(stepper.state().qdd[0]) + std::abs(stepper.state().q[0]) * 1e10;
    for (int i = 0; i < 10; ++i) stepper.step();
    const double after = std::abs(stepper.state().qdd[0]) + std::abs(stepper.state().q[0]) * 1e10;
    const double growth = rho < 1 ? 50.0 / 40 : 1;  // a double root: n rho^n
    EXPECT_NEAR(std::pow(after / before / growth, 0.1), rho, 0.03 * rho) << "rho " << rho;
  }
}

TEST(GeneralizedAlpha, RefusesParametersThatWouldNotDamp) {
  Pendulum pendulum;
  EXPECT_THAT([&] { GeneralizedAlpha(pendulum, {}, 1.5); },
              ThrowsMessage<ModelError>(HasSubstr("spectral_radius = 1.5, must be 0 to 1")));
  EXPECT_THAT([&] { Hht(pendulum, {}, 0.1); },
              ThrowsMessage<ModelError>(HasSubstr("alpha = 0.1, must be -1/3 to 0")));
  EXPECT_THAT([&] { Hht(pendulum, {.step = -1}); },
              ThrowsMessage<ModelError>(HasSubstr("HHT: step [s] = -1")));
}

}  // namespace
}  // namespace easydyn

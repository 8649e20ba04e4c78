// A double pendulum against the installed kernel: its energy must stay what it was.
#include <cmath>
#include <cstdio>
#include <easydyn/easydyn.hpp>

using namespace easydyn;

class DoublePendulum : public System {
  Coordinate a = coordinate("a");
  Coordinate b = coordinate("b", 1.0);
  Body& rod1 = body("rod 1", Inertia::rod_z(1.1, 1.2));
  Body& rod2 = body("rod 2", Inertia::rod_z(0.9, 1.1));

  void positions() override {
    rod1 = rotate_y(a) * translate(0, 0, -0.6);
    rod2 = rotate_y(a) * translate(0, 0, -1.2) * rotate_y(b) * translate(0, 0, -0.55);
  }
  void forces() override { gravity(); }
};

int main() {
  DoublePendulum pendulum;
  Newmark newmark(pendulum, {.step = 1e-3});
  const auto energy = [&] {
    const EnergyBalance balance = pendulum.compute_energy(newmark.state());
    return balance.kinetic + balance.potential;
  };
  const double at_start = energy();
  newmark.advance(2.0);
  const double change = energy() - at_start;
  std::printf("energy changed by %.1e J, kinetic energy %.3f J\n", change,
              pendulum.compute_energy(newmark.state()).kinetic);
  return std::abs(change) < 1e-4 ? 0 : 1;
}

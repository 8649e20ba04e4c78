// A high-speed train on a rough rail: contact forces, track motion and the load on the ground (step 1 of a prediction).
//
//   [traction car] [end car ]|[ car ]|[ car ]| ... |[ end car] [traction car]      10 cars, 26 axles, 200 m, --> v
//     oo    oo      oo       oo      oo      oo   oo       oo    oo    oo
//   ~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~     rail, random unevenness
//    |    |    |    |    |    |    |    |    |    |    |    |    |    |    |       pads, sleepers, ballast
//   (m_f)~(m_f)~(m_f)~(m_f)~ ...                                                    coupled lumped mass (CLM) foundation
//
// Shows: an articulated train (Jacobs bogies) at 300 km/h; an irregularity drawn from a spectrum; a window of track that
// travels with the train; a run-in before anything is recorded; several speeds in one call:
//   ./run hst --speed 150,200,250,300
// `./run hst` goes on with the ground and the report. How its levels compare with the literature: docs/accuracy.md.
// Run: build/release/bin/hst    (the bundled foundation; ./run hst fits it to the site)
// Prints: vehicle weight                                             4189 kN
// Prints: static sum of the ballast reactions / weight                  1
// Prints: largest contact force                                     193.1 kN
// Prints: largest ballast reaction                                  58.05 kN
// Reference: G. Degrande, L. Schillemans, Free field vibrations during the passage of a Thalys high-speed train at
// variable speed, J. Sound Vib. 247(1), 2001.

#include "examples/passage_program/passage_program.hpp"
#include "vehicles/thalys_like.hpp"

using namespace easydyn;

int main(int argc, char** argv) {
  examples::PassageProgram hst;
  hst.name = "hst";
  hst.title = "A high-speed train on a rough rail: contact forces, track motion and the load on the ground.";
  hst.vehicle = vehicles::thalys_like();
  hst.track = track::thalys_like_track();
  hst.speed = 300;  // km/h
  hst.least_speed = 80;
  hst.top_speed = 400;
  hst.irregularity = "braun_hellenbroich";
  hst.time_step = 2e-4;             // s
  hst.loaded = 125;                 // m: the ground is loaded from -125 m to 125 m about the receivers
  hst.margin = 32.5;                // m: a window of 260 m
  hst.approach = 10;                // m
  hst.rayleigh_speed = 0.932 * 80;  // m/s: cs 80 m/s, nu 0.33 (examples/sites/hst.toml)
  hst.heights = {.floor = 1.1, .width = 2.8};
  hst.picture_width = 60;
  hst.followed = "car 2 body";
  return examples::run_passage_program(hst, argc, argv);
}

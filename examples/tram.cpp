// A tram over a rail joint: contact forces, track motion and the load on the ground (step 1 of a prediction).
//
//      rear body         centre body        front body
//   [===========]o[====================]o[===========]     --> v
//     O  o              O    O              o  O
//   ========================================|~~~~~~~~~~     rail, step of 1 mm at x = 0
//    |pad |    |    |    |    |    |    |    |    |         pads, sleepers, ballast
//   (m_f)~(m_f)~(m_f)~(m_f)~ ...                            coupled lumped mass (CLM) foundation
//
// Shows: a vehicle from its data sheet, built into a multibody system with a flexible track; nonlinear
// contact; a smooth start in the quasi-static motion; the ballast reactions handed to the program `soil`.
// `./run tram` goes on with the ground and the report. What this program shares with others is in
// examples/passage_program; examples/my_vehicle.cpp has the same in one file.
// Run: build/release/bin/tram    (the bundled foundation; ./run tram fits it to the site)
// Prints: vehicle weight                                            358.1 kN
// Prints: static sum of the ballast reactions / weight                  1
// Prints: largest ballast reaction                                  53.58 kN
// Reference: G. Kouroussis, O. Verlinden, Prediction of railway ground vibrations: accuracy of a coupled
// lumped mass model for representing the track/soil interaction, Soil Dyn. Earthq. Eng. 69, 2015.

#include "examples/passage_program/passage_program.hpp"
#include "vehicles/t2000_like.hpp"

using namespace easydyn;

int main(int argc, char** argv) {
  examples::PassageProgram tram;
  tram.name = "tram";
  tram.title = "A tram over a rail joint: contact forces, track motion and the load on the ground.";
  tram.vehicle = vehicles::t2000_like();
  tram.track = track::t2000_like_track();
  tram.speed = 30;                    // km/h
  tram.step_height = 1;               // mm
  tram.loaded = 14;                   // m: the ground is loaded from -14 m to 14 m about the joint
  tram.rayleigh_speed = 0.935 * 109;  // m/s: cs 109 m/s, nu 0.35 (examples/sites/tram.toml)
  tram.followed = "centre body";
  return examples::run_passage_program(tram, argc, argv);
}

#include "track/foundation.hpp"

#include <array>
#include <string>

#include "easydyn/require.hpp"

namespace easydyn::track {
namespace {

template <class... Fs>
struct Overloaded : Fs... {
  using Fs::operator()...;
};
template <class... Fs>
Overloaded(Fs...) -> Overloaded<Fs...>;

}  // namespace

std::string_view kind_of(const Foundation& foundation) {
  constexpr std::array<std::string_view, 4> kinds = {"rigid", "Winkler", "Winkler with mass", "CLM"};
  return kinds[foundation.index()];
}

bool is_rigid(const Foundation& foundation) {
  return std::holds_alternative<RigidGround>(foundation);
}

Clm as_clm(const Foundation& foundation) {
  const Sourced none(0, "none in this foundation");
  return std::visit(Overloaded{
                        [&](const RigidGround&) {
                          return Clm{none, none, none, none, none};
                        },
                        [&](const Winkler& f) {
                          return Clm{none, f.k_f, f.d_f, none, none};
                        },
                        [&](const WinklerMass& f) {
                          return Clm{f.m_f, f.k_f, f.d_f, none, none};
                        },
                        [](const Clm& f) { return f; },
                    },
                    foundation);
}

void validate(const Clm& clm, std::string_view object) {
  // each constant is a number, and the foundation alone is passive
  require_not_negative(object, "m_f", clm.m_f, "kg");
  require_not_negative(object, "k_f", clm.k_f, "N/m");
  require_not_negative(object, "d_f", clm.d_f, "N s/m");
  require_finite(object, "k_c", clm.k_c, "N/m");
  require_finite(object, "d_c", clm.d_c, "N s/m");
  // neighbours in opposition, the worst wavenumber: theta = pi
  const double k = clm.k_f + 4 * clm.k_c, d = clm.d_f + 4 * clm.d_c;
  require(k >= 0, object,
          fmt::format("not passive: k_f + 4 k_c = {:g} + 4 x {:g}", clm.k_f.value, clm.k_c.value), k, "N/m",
          ">= 0");
  require(d >= 0, object,
          fmt::format("not passive: d_f + 4 d_c = {:g} + 4 x {:g}", clm.d_f.value, clm.d_c.value), d, "N s/m",
          ">= 0");
}

void validate(const Foundation& foundation, std::string_view object) {
  if (is_rigid(foundation)) return;
  const Clm clm = as_clm(foundation);
  validate(clm, object);
  require_positive(object, "k_f", clm.k_f, "N/m");
}

std::vector<Parameter> parameters(const Foundation& foundation, std::string_view object) {
  if (is_rigid(foundation)) return {};
  const Clm clm = as_clm(foundation);
  const std::string group(object);
  std::vector<Parameter> table = {{group, "foundation stiffness k_f", clm.k_f, "N/m", clm.k_f.source},
                                  {group, "foundation damping d_f", clm.d_f, "N s/m", clm.d_f.source}};
  if (foundation.index() >= 2) table.push_back({group, "foundation mass m_f", clm.m_f, "kg", clm.m_f.source});
  if (foundation.index() == 3) {
    table.push_back({group, "coupling stiffness k_c", clm.k_c, "N/m", clm.k_c.source});
    table.push_back({group, "coupling damping d_c", clm.d_c, "N s/m", clm.d_c.source});
  }
  return table;
}

}  // namespace easydyn::track

#include "easydyn/urdf/urdf_syntax.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <charconv>
#include <cmath>
#include <set>
#include <string_view>
#include <vector>

#include "easydyn/error.hpp"

namespace easydyn::urdf_syntax {

namespace {

// What an attribute holds: text, or so many numbers in a range.
struct Content {
  int numbers = 0;  // 0: text
  enum Range { any, not_negative, positive, not_zero, unit } range = any;
};
constexpr Content words{}, number{1}, not_negative{1, Content::not_negative}, positive{1, Content::positive};
constexpr Content vector3{3}, size3{3, Content::positive}, scale3{3, Content::not_zero},
    colour{4, Content::unit};

struct Attribute {
  std::string_view name;
  Content content;
  bool is_required = true;
};

enum class Count { once, at_most_once, any };

// An element: its attributes and children. `is_free`: whatever stands below it has no effect here.
struct Element {
  std::string_view name;
  std::vector<Attribute> attributes = {};
  struct Child {
    const Element* element;
    Count count = Count::at_most_once;
  };
  std::vector<Child> children = {};
  bool is_free = false;
};

// The grammar, from the leaves upward. Reference: http://wiki.ros.org/urdf/XML, as urdfdom 3.0 reads it.
const Element origin{"origin", {{"xyz", vector3, false}, {"rpy", vector3, false}}};
const Element mass{"mass", {{"value", not_negative}}};
const Element inertia{
    "inertia",
    {{"ixx", number}, {"ixy", number}, {"ixz", number}, {"iyy", number}, {"iyz", number}, {"izz", number}}};
const Element inertial{"inertial", {}, {{&origin}, {&mass, Count::once}, {&inertia, Count::once}}};
const Element box{"box", {{"size", size3}}};
const Element cylinder{"cylinder", {{"radius", positive}, {"length", positive}}};
const Element sphere{"sphere", {{"radius", positive}}};
const Element mesh{"mesh", {{"filename", words}, {"scale", scale3, false}}};
const Element geometry{"geometry", {}, {{&box}, {&cylinder}, {&sphere}, {&mesh}}};
const Element rgba{"color", {{"rgba", colour}}};
const Element texture{"texture", {{"filename", words}}};
const Element material{"material", {{"name", words}}, {{&rgba}, {&texture}}};
const Element visual{"visual",
                     {{"name", words, false}, {"group", words, false}},
                     {{&origin}, {&geometry, Count::once}, {&material}}};
const Element collision{.name = "collision", .is_free = true};
const Element contact{.name = "contact", .is_free = true};
const Element link{"link",
                   {{"name", words}, {"type", words, false}},
                   {{&inertial}, {&visual, Count::any}, {&collision, Count::any}, {&contact}}};

const Element parent{"parent", {{"link", words}}};
const Element child{"child", {{"link", words}}};
const Element axis{"axis", {{"xyz", vector3}}};
const Element limit{"limit",
                    {{"lower", number, false},
                     {"upper", number, false},
                     {"effort", not_negative},
                     {"velocity", not_negative}}};
const Element dynamics{"dynamics", {{"damping", not_negative, false}, {"friction", not_negative, false}}};
const Element mimic{"mimic", {{"joint", words}, {"multiplier", number, false}, {"offset", number, false}}};
const Element calibration{.name = "calibration", .is_free = true};
const Element safety{.name = "safety_controller", .is_free = true};
const Element joint{"joint",
                    {{"name", words}, {"type", words}},
                    {{&origin},
                     {&parent, Count::once},
                     {&child, Count::once},
                     {&axis},
                     {&limit},
                     {&dynamics},
                     {&mimic},
                     {&calibration},
                     {&safety}}};

std::string accepted_range(const Content& content) {
  std::string each = content.numbers > 1 ? fmt::format("{} numbers", content.numbers) : "a number";
  switch (content.range) {
    case Content::not_negative:
      return each + " >= 0";
    case Content::positive:
      return each + " > 0";
    case Content::not_zero:
      return each + ", none 0";
    case Content::unit:
      return each + " from 0 to 1";
    case Content::any:
      break;
  }
  return each;
}

bool is_in_range(double value, Content::Range range) {
  switch (range) {
    case Content::not_negative:
      return value >= 0;
    case Content::positive:
      return value > 0;
    case Content::not_zero:
      return value != 0;
    case Content::unit:
      return value >= 0 && value <= 1;
    case Content::any:
      break;
  }
  return true;
}

// Whether the text is what the content says. Numbers as urdfdom takes them, separated by blanks, but finite.
bool fits(std::string_view value, const Content& content) {
  if (content.numbers == 0) return !value.empty();
  int found = 0;
  while (true) {
    while (!value.empty() && value.front() == ' ') value.remove_prefix(1);
    if (value.empty()) break;
    if (value.front() == '+') value.remove_prefix(1);
    double x = 0;
    const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), x);
    if (error != std::errc() || !std::isfinite(x) || !is_in_range(x, content.range)) return false;
    value.remove_prefix(static_cast<std::size_t>(end - value.data()));
    if (!value.empty() && value.front() != ' ') return false;
    ++found;
  }
  return found == content.numbers;
}

template <class List, class Name>
std::string list_of(const List& list, Name name) {
  std::vector<std::string> names;
  names.reserve(list.size());
  for (const auto& entry : list) names.push_back(name(entry));
  return names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", "));
}

// A document and the part of it that is being checked.
struct Checker {
  const std::filesystem::path& file;
  std::string object;

  void check(const TiXmlElement& e, const Element& rule) const {
    if (rule.is_free) return;
    check_attributes(e, rule);
    std::set<std::string> seen;
    for (const TiXmlElement* c = e.FirstChildElement(); c; c = c->NextSiblingElement()) {
      const std::string& name = c->ValueStr();
      refuse_xacro(*c);
      if (name.find(':') != std::string::npos) continue;  // an extension with a namespace of its own
      const Element::Child* known = nullptr;
      for (const Element::Child& r : rule.children)
        if (r.element->name == name) known = &r;
      if (!known)
        refuse(file, *c, object,
               fmt::format("<{}> has the unknown element <{}>, accepted: {}", rule.name, name,
                           list_of(rule.children,
                                   [](const auto& r) { return fmt::format("<{}>", r.element->name); })));
      if (!seen.insert(name).second && known->count != Count::any)
        refuse(file, *c, object, fmt::format("<{}> has a second element <{}>, must be one", rule.name, name));
      check(*c, *known->element);
    }
    for (const Element::Child& r : rule.children)
      if (r.count == Count::once && seen.count(std::string(r.element->name)) == 0)
        refuse(file, e, object, fmt::format("<{}> has no element <{}>", rule.name, r.element->name));
    if (&rule == &geometry && seen.size() != 1)
      refuse(file, e, object,
             fmt::format("<geometry> has {} shapes, must be one of <box>, <cylinder>, <sphere>, <mesh>",
                         seen.size()));
  }

  void check_attributes(const TiXmlElement& e, const Element& rule) const {
    for (const TiXmlAttribute* a = e.FirstAttribute(); a; a = a->Next()) {
      const std::string_view name = a->Name();
      const Attribute* known = nullptr;
      for (const Attribute& r : rule.attributes)
        if (r.name == name) known = &r;
      if (!known)
        refuse(file, *a, object,
               fmt::format("<{}> has the unknown attribute {}, accepted: {}", rule.name, name,
                           list_of(rule.attributes, [](const Attribute& r) { return std::string(r.name); })));
      if (!fits(a->ValueStr(), known->content))
        refuse(file, *a, object,
               fmt::format("<{}> {} = \"{}\", must be {}", rule.name, name, a->Value(),
                           known->content.numbers ? accepted_range(known->content) : "a name"));
    }
    for (const Attribute& r : rule.attributes)
      if (r.is_required && !e.Attribute(std::string(r.name).c_str()))
        refuse(file, e, object, fmt::format("<{}> has no attribute {}", rule.name, r.name));
  }

  void refuse_xacro(const TiXmlElement& e) const {
    if (e.ValueStr().rfind("xacro:", 0) == 0)
      refuse(
          file, e, object,
          fmt::format("<{}> is a macro of xacro, which is not expanded here: run xacro first", e.ValueStr()));
  }
};

}  // namespace

void refuse(const std::filesystem::path& file, const TiXmlBase& place, const std::string& object,
            const std::string& reason) {
  throw InputError(fmt::format("{}:{}:{}: {}{}{}", file.string(), place.Row(), place.Column(), object,
                               object.empty() ? "" : ": ", reason));
}

std::string label_of(const TiXmlElement& element) {
  const char* const name = element.Attribute("name");
  return name ? fmt::format("{} \"{}\"", element.Value(), name) : element.ValueStr();
}

void parse(TiXmlDocument& document, const std::string& text, const std::filesystem::path& file) {
  document.Parse(text.c_str());
  if (document.Error())
    throw InputError(fmt::format("{}:{}:{}: not well-formed XML: {}", file.string(), document.ErrorRow(),
                                 document.ErrorCol(), document.ErrorDesc()));
  const TiXmlElement* const robot = document.RootElement();
  if (!robot || robot->ValueStr() != "robot")
    throw InputError(fmt::format("{}:{}:1: the root element is {}, must be <robot>", file.string(),
                                 robot ? robot->Row() : 1,
                                 robot ? "<" + robot->ValueStr() + ">" : "missing"));
  if (!robot->Attribute("name")) refuse(file, *robot, "", "<robot> has no attribute name");
  for (const TiXmlElement* e = robot->FirstChildElement(); e; e = e->NextSiblingElement()) {
    const Checker checker{file, label_of(*e)};
    checker.refuse_xacro(*e);
    for (const Element* rule : {&link, &joint, &material})
      if (e->ValueStr() == rule->name) checker.check(*e, *rule);
  }
}

}  // namespace easydyn::urdf_syntax

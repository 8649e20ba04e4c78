#include "easydyn/visu/svg.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <set>
#include <vector>

#include "easydyn/error.hpp"

namespace easydyn::visu::svg {

namespace {

const std::set<std::string, std::less<>> accepted_elements = {
    "svg",  "title",   "desc",     "g",       "line", "rect", "circle",
    "path", "ellipse", "polyline", "polygon", "text", "tspan"};

const std::set<std::string, std::less<>> accepted_attributes = {"cx",
                                                                "cy",
                                                                "d",
                                                                "dx",
                                                                "dy",
                                                                "height",
                                                                "points",
                                                                "r",
                                                                "rotate",
                                                                "rx",
                                                                "ry",
                                                                "transform",
                                                                "width",
                                                                "x",
                                                                "x1",
                                                                "x2",
                                                                "y",
                                                                "y1",
                                                                "y2",  //
                                                                "fill",
                                                                "fill-opacity",
                                                                "fill-rule",
                                                                "opacity",
                                                                "paint-order",
                                                                "stroke",
                                                                "stroke-dasharray",
                                                                "stroke-dashoffset",
                                                                "stroke-linecap",
                                                                "stroke-linejoin",
                                                                "stroke-miterlimit",
                                                                "stroke-opacity",
                                                                "stroke-width",  //
                                                                "dominant-baseline",
                                                                "font-family",
                                                                "font-size",
                                                                "font-style",
                                                                "font-weight",
                                                                "letter-spacing",
                                                                "text-anchor",  //
                                                                "aria-label",
                                                                "preserveAspectRatio",
                                                                "role",
                                                                "viewBox",
                                                                "xmlns"};

bool is_space(char c) {
  return c == ' ' || c == '\t' || c == '\n' || c == '\r';
}

bool is_name_letter(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) || c == '-' || c == '_' || c == ':';
}

class Reader {
 public:
  explicit Reader(std::string_view text) : text_(text) {}

  Drawing read() {
    skip_declaration();
    skip_space();
    const std::size_t start = at_;
    read_tag();
    if (open_.empty() || open_.front() != "svg") refuse("must be one <svg> element");
    while (!open_.empty()) {
      if (at_ == text_.size()) refuse(fmt::format("<{}> is not closed", open_.back()));
      if (text_[at_] == '<')
        read_tag();
      else
        read_text();
    }
    const std::size_t end = at_;
    skip_space();
    if (at_ != text_.size()) refuse("must end with </svg>");
    if (title_.find_first_not_of(" \t\r\n") == title_.npos)
      refuse("has no <title> as the first element of <svg>");

    Drawing drawing{title_, std::string(text_.substr(start, end - start))};
    if (!has_role_) drawing.markup.insert(std::string("<svg").size(), " role=\"img\"");
    return drawing;
  }

 private:
  std::string_view text_;
  std::size_t at_ = 0;
  std::vector<std::string> open_;  // elements around the place that is read
  std::string title_;
  bool has_role_ = false;
  int child_ = 0;  // elements of <svg> so far

  [[noreturn]] void refuse(const std::string& why) const {
    const auto line = 1 + std::count(text_.begin(), text_.begin() + static_cast<std::ptrdiff_t>(at_), '\n');
    throw ModelError(fmt::format("drawing \"{}\", line {}: {}", title_, line, why));
  }

  void skip_space() {
    while (at_ < text_.size() && is_space(text_[at_])) ++at_;
  }
  bool take(std::string_view expected) {
    if (text_.substr(at_, expected.size()) != expected) return false;
    at_ += expected.size();
    return true;
  }
  std::string read_name() {
    const std::size_t start = at_;
    while (at_ < text_.size() && is_name_letter(text_[at_])) ++at_;
    return std::string(text_.substr(start, at_ - start));
  }

  void skip_declaration() {
    skip_space();
    if (!take("<?xml ")) return;
    const std::size_t end = text_.find("?>", at_);
    if (end == text_.npos) refuse("the XML declaration is not closed");
    at_ = end + 2;
  }

  void read_tag() {
    if (!take("<")) refuse("must be one <svg> element");
    if (take("/")) {
      const std::string name = read_name();
      skip_space();
      if (!take(">") || open_.empty() || open_.back() != name)
        refuse(fmt::format("</{}> closes nothing", name));
      open_.pop_back();
      return;
    }
    const std::string name = read_name();
    if (!accepted_elements.contains(name)) refuse(fmt::format("<{}> is not accepted in a drawing", name));
    if ((name == "svg") != open_.empty()) refuse("<svg> must be the one outer element");
    // What stands in title and desc is plain text, in HTML too.
    if (!open_.empty() && (open_.back() == "title" || open_.back() == "desc"))
      refuse(fmt::format("<{}> may hold text only", open_.back()));
    if (open_.size() == 1) ++child_;

    std::set<std::string> given;
    while (true) {
      const bool has_space = at_ < text_.size() && is_space(text_[at_]);
      skip_space();
      if (take("/>")) break;
      if (take(">")) {
        open_.push_back(name);
        break;
      }
      if (!has_space) refuse(fmt::format("<{}> is not well-formed", name));
      read_attribute(name, given);
    }
    if (name != "svg") return;
    if (!given.contains("viewBox")) refuse("<svg> has no viewBox");
    has_role_ = given.contains("role");
  }

  void read_attribute(const std::string& element, std::set<std::string>& given) {
    const std::string name = read_name();
    if (name.empty()) refuse(fmt::format("<{}> is not well-formed", element));
    if (!accepted_attributes.contains(name))
      refuse(fmt::format("<{}>: attribute {} is not accepted in a drawing", element, name));
    if (!given.insert(name).second) refuse(fmt::format("<{}>: attribute {} is given twice", element, name));
    skip_space();
    const bool has_equals = take("=");
    skip_space();
    const bool is_double = take("\"");
    if (!has_equals || (!is_double && !take("'")))
      refuse(fmt::format("<{}>: attribute {} has no value in quotes", element, name));
    const std::size_t end = text_.find(is_double ? '"' : '\'', at_);
    if (end == text_.npos) refuse(fmt::format("<{}>: the value of {} is not closed", element, name));
    const std::string_view value = text_.substr(at_, end - at_);
    const auto fault = [&](const char* what) {
      refuse(fmt::format("<{}>: {} = \"{}\" {}", element, name, value, what));
    };
    if (value.find_first_of("<\\") != value.npos) fault("holds < or \\");
    check_entities(value);
    // Functions of CSS load or hide; those of a transform only move.
    if (name != "transform" && value.find('(') != value.npos) fault("holds a function");
    if (name == "xmlns" && value != "http://www.w3.org/2000/svg") fault("is not SVG");
    if (name == "role" && value != "img") fault("must be img");
    at_ = end + 1;
  }

  void read_text() {
    const std::size_t end = std::min(text_.find('<', at_), text_.size());
    const std::string_view words = text_.substr(at_, end - at_);
    check_entities(words);
    if (open_.size() == 2 && open_.back() == "title" && child_ == 1) title_ += plain(words);
    at_ = end;
  }

  /// & begins one of the entities that XML and HTML share, in the words from here on.
  void check_entities(std::string_view words) {
    for (std::size_t i = 0; (i = words.find('&', i)) != words.npos; ++i) {
      if (std::any_of(entities.begin(), entities.end(),
                      [&](const auto& e) { return words.substr(i).starts_with(e.first); }))
        continue;
      at_ += i;
      refuse("& must be one of &amp; &lt; &gt; &quot; &#39;");
    }
  }

  static constexpr std::array<std::pair<std::string_view, char>, 5> entities = {
      {{"&amp;", '&'}, {"&lt;", '<'}, {"&gt;", '>'}, {"&quot;", '"'}, {"&#39;", '\''}}};

  static std::string plain(std::string_view words) {
    std::string out;
    for (std::size_t i = 0; i < words.size();) {
      const auto entity = std::find_if(entities.begin(), entities.end(),
                                       [&](const auto& e) { return words.substr(i).starts_with(e.first); });
      out += entity == entities.end() ? words[i] : entity->second;
      i += entity == entities.end() ? 1 : entity->first.size();
    }
    return out;
  }
};

}  // namespace

Drawing read(std::string_view text, std::size_t max_bytes) {
  if (text.size() > max_bytes)
    throw ModelError(fmt::format("drawing of {} bytes, must have at most {}", text.size(), max_bytes));
  return Reader(text).read();
}

}  // namespace easydyn::visu::svg

#pragma once

#include <cctype>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/temporary_folder.hpp"

namespace easydyn::testing {

/// The elements of an XML text in order, with attributes and the text behind the start tag.
struct XmlElement {
  std::string name, parent, text;
  std::map<std::string, std::string> attributes;
};

/// @throws std::runtime_error if the text is not well-formed: one root, tags nested and closed, attributes quoted
/// and given once, no stray < or &. (No comments, CDATA or DTD: our files have none.)
inline std::vector<XmlElement> parse_xml(const std::string& xml) {
  const auto fail = [](const std::string& what) -> void { throw std::runtime_error("XML: " + what); };
  std::vector<XmlElement> elements;
  std::vector<std::size_t> open;
  std::size_t at = 0;
  if (xml.starts_with("<?xml")) at = xml.find("?>") + 2;
  const auto is_name = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; };
  while (at < xml.size()) {
    const std::size_t tag = xml.find('<', at);
    const std::string text = xml.substr(at, tag - at);
    for (const char c : text)
      if (open.empty() && !std::isspace(static_cast<unsigned char>(c))) fail("text outside the root");
    if (text.find('&') != std::string::npos) fail("&");
    if (!open.empty()) elements[open.back()].text += text;
    if (tag == std::string::npos) break;
    at = tag + 1;
    if (xml.at(at) == '/') {
      const std::size_t end = xml.find('>', at);
      if (open.empty() || xml.substr(at + 1, end - at - 1) != elements[open.back()].name) fail("end tag");
      open.pop_back();
      at = end + 1;
      continue;
    }
    if (open.empty() && !elements.empty()) fail("two roots");
    XmlElement element;
    if (!open.empty()) element.parent = elements[open.back()].name;
    while (is_name(xml.at(at))) element.name += xml[at++];
    if (element.name.empty()) fail("no name");
    bool closed = false;
    while (true) {
      while (std::isspace(static_cast<unsigned char>(xml.at(at)))) ++at;
      if (xml[at] == '>') break;
      if (xml[at] == '/') {
        closed = true;
        if (xml.at(++at) != '>') fail("/");
        break;
      }
      std::string name;
      while (is_name(xml.at(at))) name += xml[at++];
      if (name.empty() || xml.at(at) != '=' || xml.at(at + 1) != '"') fail("attribute of " + element.name);
      const std::size_t end = xml.find('"', at + 2);
      const std::string value = xml.substr(at + 2, end - at - 2);
      if (value.find('<') != std::string::npos) fail("< in " + name);
      if (!element.attributes.emplace(name, value).second) fail(name + " twice");
      at = end + 1;
    }
    ++at;
    if (!closed) open.push_back(elements.size());
    elements.push_back(std::move(element));
  }
  if (!open.empty()) fail("not closed: " + elements[open.back()].name);
  return elements;
}

inline std::string decode_base64(const std::string& text) {
  static const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  std::uint32_t bits = 0;
  int count = 0;
  for (const char c : text) {
    if (c == '=') break;
    const std::size_t digit = digits.find(c);
    if (digit == std::string::npos) throw std::runtime_error("base64");
    bits = bits << 6 | static_cast<std::uint32_t>(digit);
    if ((count += 6) >= 8) {
      count -= 8;
      bytes += static_cast<char>(bits >> count & 255);
    }
  }
  return bytes;
}

/// A VTU file as a reader of the VTK format sees it.
struct VtuContent {
  std::size_t points = 0, cells = 0;
  double time = 0;
  std::map<std::string, std::string> arrays, types;  ///< bytes and type by name

  template <class T>
  std::vector<T> values(const std::string& name) const {
    const std::string& bytes = arrays.at(name);
    std::vector<T> result(bytes.size() / sizeof(T));
    std::memcpy(result.data(), bytes.data(), bytes.size());
    return result;
  }
};

inline VtuContent read_vtu(const std::filesystem::path& path) {
  const std::vector<XmlElement> elements = parse_xml(read_whole_file(path));
  VtuContent content;
  std::string data;
  for (const XmlElement& e : elements)
    if (e.name == "AppendedData") data = e.text.substr(e.text.find('_') + 1);
  for (const XmlElement& e : elements) {
    if (e.name == "Piece") {
      content.points = std::stoul(e.attributes.at("NumberOfPoints"));
      content.cells = std::stoul(e.attributes.at("NumberOfCells"));
    }
    if (e.name != "DataArray") continue;
    if (e.parent == "FieldData") {
      content.time = std::stod(e.text);
      continue;
    }
    const std::string run = data.substr(std::stoul(e.attributes.at("offset")));
    std::uint64_t size = 0;
    std::memcpy(&size, decode_base64(run.substr(0, 12)).data(), sizeof size);
    const std::string bytes = decode_base64(run.substr(0, (sizeof size + size + 2) / 3 * 4));
    content.arrays[e.attributes.at("Name")] = bytes.substr(sizeof size);
    content.types[e.attributes.at("Name")] = e.attributes.at("type");
  }
  return content;
}

}  // namespace easydyn::testing

#pragma once

// Private to urdf: TinyXML stands in its interface.

#include <tinyxml.h>

#include <filesystem>
#include <string>

namespace easydyn::urdf_syntax {

/// Refuses with `file:line:column: object: reason`; the object, e.g. `link "arm"`, may be empty.
[[noreturn]] void refuse(const std::filesystem::path& file, const TiXmlBase& place, const std::string& object,
                         const std::string& reason);

/// `link "arm"`: what an error calls an element of the robot.
std::string label_of(const TiXmlElement& element);

/// Parses the text and checks every link, joint and material against the grammar of URDF: elements and attributes known,
/// none missing, none twice, numbers finite and in their range.
///
/// urdfdom needs this check before it: it ignores what it does not know, so that a misspelt <inertial> is a link without
/// mass, and takes a number that it cannot read as 0.
/// @throws InputError as refuse()
void parse(TiXmlDocument& document, const std::string& text, const std::filesystem::path& file);

}  // namespace easydyn::urdf_syntax

#pragma once

// Private to the report: which drawings may stand in a page.

#include <string>
#include <string_view>

namespace easydyn::visu::svg {

/// What a page needs to know of a drawing.
struct Drawing {
  std::string title;   ///< of its `<title>`, plain text
  std::string markup;  ///< the `<svg>` element with `role="img"`, as it may stand in an HTML page
};

/// Reads an SVG image and accepts what only draws: elements and attributes for lines, shapes and text. Nothing that
/// runs, loads, links or styles (`<script>`, `<image>`, `<use>`, `<style>`, `on...`, `href`, `style`, `id`, `url(...)`),
/// no comments, processing instructions or entities of its own, so that a page with the drawing is as safe as one
/// without.
/// @throws ModelError naming the element and what is wrong: text that is not well-formed, an element or attribute that
///         is not accepted, no `viewBox`, no `<title>` as first child of `<svg>`, more than `max_bytes`
Drawing read(std::string_view text, std::size_t max_bytes = 1'000'000);

}  // namespace easydyn::visu::svg

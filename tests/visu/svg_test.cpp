#include "easydyn/visu/svg.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "easydyn/error.hpp"
#include "tests/temporary_folder.hpp"

using namespace easydyn;
using namespace easydyn::visu;
using easydyn::testing::message_of;
using ::testing::HasSubstr;

namespace {

std::string with(const std::string& content) {
  return "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 9 9\" role=\"img\">\n<title>car</title>\n" +
         content + "\n</svg>";
}

}  // namespace

TEST(SvgDrawing, IsTakenAsItIsIfItOnlyDraws) {
  const std::string text = with(
      "<g transform=\"translate(1 2)\"><rect width=\"100%\" height='1' fill=\"#fff\"/>"
      "<path d=\"M0 0 l-8 -4 v8 z\" /><text x=\"1\">5 &lt; 6<tspan>!</tspan></text></g>");
  const svg::Drawing drawing = svg::read("\n" + text + "\n");
  EXPECT_EQ(drawing.title, "car");
  EXPECT_EQ(drawing.markup, text);
}

TEST(SvgDrawing, HasATitleInPlainText) {
  const svg::Drawing drawing = svg::read("<svg viewBox=\"0 0 1 1\"><title>a &lt; b &amp; c</title></svg>");
  EXPECT_EQ(drawing.title, "a < b & c");
  EXPECT_EQ(drawing.markup, "<svg role=\"img\" viewBox=\"0 0 1 1\"><title>a &lt; b &amp; c</title></svg>");
  for (const char* none :
       {"<svg viewBox=\"0 0 1 1\"></svg>", "<svg viewBox=\"0 0 1 1\"><title> </title></svg>",
        "<svg viewBox=\"0 0 1 1\"><g/><title>late</title></svg>"})
    EXPECT_THAT(message_of<ModelError>([&] { svg::read(none); }), HasSubstr("<title>")) << none;
}

TEST(SvgDrawing, IsRefusedIfItRunsLoadsLinksOrStyles) {
  for (const char* bad : {"<script>alert(1)</script>",
                          "<g onclick=\"alert(1)\"/>",
                          "<g ONLOAD=\"alert(1)\"/>",
                          "<a href=\"https://example.org\"><g/></a>",
                          "<image href=\"https://example.org/a.png\"/>",
                          "<use href=\"#a\"/>",
                          "<style>* { display: none }</style>",
                          "<g style=\"fill: url(#a)\"/>",
                          "<rect fill=\"url(https://example.org/#a)\"/>",
                          "<rect fill=\"red URL(#a)\"/>",
                          "<rect fill=\"u\\72l(#a)\"/>",
                          "<foreignObject><p>x</p></foreignObject>",
                          "<animate attributeName=\"x\"/>",
                          "<g id=\"page-data\"/>",
                          "<!-- -->",
                          "<![CDATA[<script>]]>",
                          "<?php ?>",
                          "&nbsp;",
                          "<g xmlns=\"http://www.w3.org/1999/xhtml\"/>",
                          "<desc><g/></desc>",
                          "<svg viewBox=\"0 0 1 1\"/>"})
    EXPECT_THAT(message_of<ModelError>([&] { svg::read(with(bad)); }), HasSubstr("drawing \"car\", line 3"))
        << bad;
}

TEST(SvgDrawing, IsRefusedIfItIsNotWellFormed) {
  for (const std::string& bad :
       {std::string(), std::string("text"), std::string("<g/>"), with("<g>"), with("</g>"),
        with("<g></rect>"), with("<g") + ">", with("<g x=1/>"), with("<g x/>"), with("<g x=\"1\"y=\"2\"/>"),
        with("<g x=\"1\" x=\"2\"/>"), with("<g x=\"1"), with("<g x=\"<\"/>"), with("") + "<svg/>",
        with("") + "x", "<?xml " + with(""), std::string("<svg><title>no viewBox</title></svg>"),
        std::string("<svg viewBox=\"0 0 1 1\"/>")})
    EXPECT_THAT(message_of<ModelError>([&] { svg::read(bad); }), HasSubstr("drawing")) << bad;
}

TEST(SvgDrawing, IsRefusedIfItIsTooLarge) {
  EXPECT_THAT(message_of<ModelError>([&] { svg::read(with(""), 50); }), HasSubstr("must have at most 50"));
}

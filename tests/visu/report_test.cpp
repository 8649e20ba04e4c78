#include "easydyn/visu/report.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "easydyn/error.hpp"
#include "easydyn/visu/html.hpp"
#include "tests/temporary_folder.hpp"

using namespace easydyn;
using namespace easydyn::visu;
using easydyn::testing::message_of;
using easydyn::testing::read_whole_file;
using easydyn::testing::TemporaryFolder;
using ::testing::HasSubstr;
using ::testing::Not;

namespace {

Chart noise(Eigen::Index n) {
  return {.title = "noise",
          .x = {"time", "s"},
          .y = {"velocity", "mm/s"},
          .series = {{"receiver", Eigen::VectorXd::LinSpaced(n, 0, 1), Eigen::VectorXd::Random(n)}}};
}

}  // namespace

TEST(HtmlText, EscapesMarkupAndSetsBackticksAsCode) {
  EXPECT_EQ(html::escaped("a < b & \"c\" > 'd'"), "a &lt; b &amp; &quot;c&quot; &gt; &#39;d&#39;");
  EXPECT_EQ(html::inline_text("run `soil <x>` now"), "run <code>soil &lt;x&gt;</code> now");
  EXPECT_EQ(html::inline_text("one ` alone"), "one ` alone");
}

TEST(HtmlText, LetsNoDataEndAScript) {
  EXPECT_EQ(html::inside_script("\"</script><!--\""), "\"\\u003c/script>\\u003c!--\"");
}

TEST(Report, ShowsTextThatLooksLikeMarkupAsText) {
  Report report("<b>title</b>");
  report.add_paragraph("<script>alert(1)</script>")
      .add_table({{"<th>"}, {{"</td>"}}, "<caption>"})
      .add_text("site.toml", "</pre>")
      .add_facts({{"<dt>", "</dd>"}})
      .add_key_figures({{"<name>", "<1>", "<unit>", "<remark>"}})
      .add_parameters({{"<group>", "<p>", 1.5, "<u>", "<s>"}});
  Chart chart = noise(10);
  chart.title = "</script><script>alert(2)</script>";
  report.add_chart(chart);
  const std::string page = report.html();
  for (const char* bad : {"<b>title", "<script>alert", "<caption>", "<name>", "<group>", "<remark>"})
    EXPECT_THAT(page, Not(HasSubstr(bad))) << bad;
  EXPECT_THAT(page, HasSubstr("&lt;b&gt;title&lt;/b&gt;"));
}

TEST(Report, LoadsNothingFromElsewhere) {
  Report report("page");
  report.add_chart(noise(10));
  const std::string page = report.html();
  EXPECT_THAT(page, HasSubstr("default-src 'none'"));
  for (const char* bad : {" src=", "<link rel=\"stylesheet", "@import", "url(", "import("})
    EXPECT_THAT(page, Not(HasSubstr(bad))) << bad;
}

TEST(Report, AlignsColumnsOfNumbersToTheRight) {
  Report report("page");
  report.add_table({{"receiver", "PPV [mm/s]"}, {{"8 m", "0.31"}, {"house", "\u2013"}}, ""});
  EXPECT_THAT(report.html(), HasSubstr("<td>house</td><td class=\"right\">\u2013</td>"));
}

TEST(Report, StaysBelowFiveMegabytesWithManyLongCurves) {
  Report report("page");
  for (int i = 0; i < 20; ++i) {
    Chart chart = noise(30000);
    for (int s = 0; s < 5; ++s) chart.series.push_back(chart.series[0]);
    report.add_chart(std::move(chart));
  }
  EXPECT_LT(report.html().size(), 5'000'000u);
}

TEST(Report, WritesItsFileInOneStep) {
  const TemporaryFolder folder;
  Report report("first");
  report.write(folder / "page.html");
  EXPECT_THAT(read_whole_file(folder / "page.html"), HasSubstr("<h1>first</h1>"));
  EXPECT_EQ(folder.count(), 1);  // no temporary file is left

  // a page that cannot be made leaves the old one untouched
  Chart broken = noise(10);
  broken.series[0].x.resize(3);
  Report second("second");
  second.add_chart(broken);
  EXPECT_THAT(message_of<ModelError>([&] { second.write(folder / "page.html"); }),
              HasSubstr("series \"receiver\""));
  EXPECT_THAT(read_whole_file(folder / "page.html"), HasSubstr("<h1>first</h1>"));
  EXPECT_EQ(folder.count(), 1);
}

TEST(Report, SaysWhichFileCannotBeWritten) {
  const TemporaryFolder folder;
  const auto path = folder / "missing/page.html";
  EXPECT_THAT(message_of<InputError>([&] { Report("page").write(path); }), HasSubstr(path.string()));
}

TEST(Report, RefusesATableWhoseRowsDoNotFitItsHeadings) {
  Report report("page");
  report.add_table({{"a", "b"}, {{"1"}}, "indicators"});
  EXPECT_THAT(message_of<ModelError>([&] { report.html(); }),
              HasSubstr("table \"indicators\": a row of 1 cells under 2"));
}

TEST(Report, FoldsATableUnderItsCaption) {
  Report report("page");
  report.add_table({{"axle", "load [kN]"}, {{"1", "142"}, {"2", "143"}}, "Axle loads", true});
  const std::string page = report.html();
  EXPECT_THAT(
      page,
      HasSubstr("<details><summary class=\"heading\"><span class=\"number\">Table 1</span> Axle loads"));
  EXPECT_THAT(page, HasSubstr("(2 rows)"));
  EXPECT_THAT(page, HasSubstr("</table></div></details>"));
}

TEST(Report, SetsADrawingOverTheFullWidthWithRoleAndTitle) {
  Report report("page");
  report.add_drawing("<?xml version=\"1.0\"?>\n<svg viewBox=\"0 0 10 10\"><title>A &amp; B</title></svg>\n",
                     "to scale");
  const std::string page = report.html();
  EXPECT_THAT(page, HasSubstr("<figure class=\"drawing\">"));
  EXPECT_THAT(page, HasSubstr("<span class=\"number\">Figure 1</span> A &amp; B</p>"));
  EXPECT_THAT(page,
              HasSubstr("<svg role=\"img\" viewBox=\"0 0 10 10\"><title>A &amp; B</title></svg></div>"));
  EXPECT_THAT(page, HasSubstr("<p class=\"caption\">to scale</p>"));
  EXPECT_THAT(page, Not(HasSubstr("<?xml")));
}

TEST(Report, RefusesDrawingsOfMoreThanAMegabyteTogether) {
  const std::string half =
      "<svg viewBox=\"0 0 1 1\"><title>t</title><desc>" + std::string(600'000, 'x') + "</desc></svg>";
  Report report("page");
  report.add_drawing(half);
  EXPECT_LT(report.html().size(), 5'000'000u);
  report.add_drawing(half);
  EXPECT_THAT(message_of<ModelError>([&] { report.html(); }), HasSubstr("must have at most"));
}

TEST(AnimationPage, HoldsTheSceneAndItsCharts) {
  const TemporaryFolder folder;
  Scene scene;
  scene.name = "Pendulum";
  scene.time = Eigen::Vector2d(0, 1);
  scene.frames = {{"rod", {Pose{}, Pose{}}, {}}};
  scene.items = {{.name = "rod", .frame = "rod"}};
  write_animation_page(folder / "page.html", "Double pendulum", scene, {noise(20)}, "Free motion.");
  const std::string page = read_whole_file(folder / "page.html");
  EXPECT_THAT(page, HasSubstr("data-scene=\"0\""));
  EXPECT_THAT(page, HasSubstr("data-chart=\"0\""));
  EXPECT_THAT(page, HasSubstr("easydyn-scene-1"));
}

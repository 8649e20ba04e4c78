#include "easydyn/visu/table_json.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "easydyn/error.hpp"
#include "tests/temporary_folder.hpp"

using namespace easydyn;
using namespace easydyn::visu;
using easydyn::testing::message_of;
using ::testing::HasSubstr;

TEST(TableJson, GivesBackTheTables) {
  const std::vector<Table> tables = {
      {{"axle", "load [kN]"}, {{"1 \"front\"", "142.2"}, {"2", "\u2013"}}, "Axle loads"},
      {{"part"}, {}, "Empty"}};
  const std::vector<Table> read = tables_from_json(to_json(tables), "test");
  ASSERT_EQ(read.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(read[i].caption, tables[i].caption);
    EXPECT_EQ(read[i].header, tables[i].header);
    EXPECT_EQ(read[i].rows, tables[i].rows);
  }
  EXPECT_TRUE(tables_from_json(to_json(std::vector<Table>{}), "test").empty());
}

TEST(TableJson, SaysWhatIsWrong) {
  const auto fault = [](const std::string& text) {
    return message_of<InputError>([&] { tables_from_json(text, "results.h5:/vehicle/tables"); });
  };
  EXPECT_THAT(fault("[{\"title\":\"Loads\",\"header\":[\"a\",\"b\"],\"rows\":[[\"1\"]]}]"),
              HasSubstr("results.h5:/vehicle/tables: table \"Loads\": a row of 1 cells under 2 headings"));
  EXPECT_THAT(fault("[{\"title\":\"Loads\",\"header\":[]}]"), HasSubstr("rows"));
  EXPECT_THAT(fault("[{\"title\":\"Loads\",\"header\":[1],\"rows\":[]}]"),
              HasSubstr("results.h5:/vehicle/tables"));
  EXPECT_THAT(fault("{"), HasSubstr("results.h5:/vehicle/tables:1:"));
}

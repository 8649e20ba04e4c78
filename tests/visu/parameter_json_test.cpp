#include "easydyn/visu/parameter_json.hpp"

#include <gmock/gmock.h>

#include "easydyn/error.hpp"

namespace easydyn::visu {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::ThrowsMessage;

TEST(ParameterJson, GivesBackTheTableThatItWrote) {
  const std::vector<Parameter> table{{"track \"a\"", "pad stiffness", 1.8e8, "N/m", "M-l: class <1>"},
                                     {"vehicle", "friction", 0.1 + 0.2, "1", ""}};
  const std::vector<Parameter> back = parameters_from_json(to_json(table), "test");
  ASSERT_EQ(back.size(), table.size());
  for (std::size_t i = 0; i < table.size(); ++i) {
    EXPECT_EQ(back[i].group, table[i].group);
    EXPECT_EQ(back[i].name, table[i].name);
    EXPECT_EQ(back[i].value, table[i].value);
    EXPECT_EQ(back[i].unit, table[i].unit);
    EXPECT_EQ(back[i].source, table[i].source);
  }
}

TEST(ParameterJson, NamesWhatIsMissing) {
  EXPECT_THAT([] { parameters_from_json(R"([{"group": "track"}])", "results.h5:/parameters"); },
              ThrowsMessage<InputError>(AllOf(HasSubstr("results.h5:/parameters"), HasSubstr("name"))));
}

}  // namespace
}  // namespace easydyn::visu

#include "easydyn/visu/json.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "easydyn/error.hpp"
#include "tests/temporary_folder.hpp"

using namespace easydyn;
using namespace easydyn::visu;
using easydyn::testing::message_of;
using ::testing::HasSubstr;

TEST(JsonText, EscapesQuotesBackslashesAndControlCharacters) {
  EXPECT_EQ(json::quoted("a \"b\" \\ \n\t\r\x01 é"), "\"a \\\"b\\\" \\\\ \\n\\t\\r\\u0001 é\"");
}

TEST(JsonText, WritesNumbersThatReadBackExactlyAndNullForWhatIsNotFinite) {
  const double number = 0.1 + 0.2;
  EXPECT_EQ(json::parse(json::Value(number).text(), "t").number(), number);
  EXPECT_EQ(json::Value(std::nan("")).text(), "null");
  EXPECT_EQ(json::Value(std::numeric_limits<double>::infinity()).text(), "null");
}

TEST(JsonText, KeepsTheOrderOfMembers) {
  EXPECT_EQ(json::object({{"z", 1}, {"a", json::Value::Array{true, "x", {}}}}).text(),
            R"({"z":1,"a":[true,"x",null]})");
}

TEST(JsonParser, ReadsWhatWasWritten) {
  const std::string text =
      R"({"name":"a\"b\u00e9\ud83d\ude82","list":[1,-2.5e3,[],{}],"yes":true,"none":null})";
  const json::Value value = json::parse(text, "t");
  EXPECT_EQ(value.at("name").string(), "a\"b\u00e9\U0001F682");
  EXPECT_EQ(value.at("list").array()[1].number(), -2500);
  EXPECT_TRUE(value.at("yes").boolean());
  EXPECT_TRUE(value.at("none").is_null());
  EXPECT_EQ(json::parse(value.text(), "again").text(), value.text());
}

TEST(JsonParser, SaysWhereATextIsWrong) {
  const auto message = [](const std::string& text) {
    return message_of<InputError>([&] { json::parse(text, "p.json"); });
  };
  EXPECT_THAT(message("{\n  \"a\": 1,\n  b\n}"), HasSubstr("p.json:3:3: expected the name of a member"));
  EXPECT_THAT(message("[1, 2"), HasSubstr("p.json:1:6: expected ',' or ']'"));
  EXPECT_THAT(message("\"abc"), HasSubstr("a string has no end"));
  EXPECT_THAT(message("\"\\ud800\""), HasSubstr("surrogate"));
  EXPECT_THAT(message("\"\\q\""), HasSubstr("unknown escape"));
  EXPECT_THAT(message("1 2"), HasSubstr("expected the end of the text"));
  EXPECT_THAT(message(""), HasSubstr("found the end of the text"));
  EXPECT_THAT(message("nan"), HasSubstr("expected a value"));
  EXPECT_THAT(message(std::string(200, '[')), HasSubstr("levels deep"));
}

TEST(JsonValue, NamesAMissingMemberAndAWrongType) {
  const json::Value value = json::object({{"a", 1}});
  EXPECT_THAT(message_of<InputError>([&] { value.at("b"); }), HasSubstr("member \"b\" is missing"));
  EXPECT_THAT(message_of<InputError>([&] { value.at("a").string(); }),
              HasSubstr("expected a string, found 1"));
}

TEST(Base64, GivesTheTextsOfRfc4648AndReadsThemBack) {
  // "foob" and "arfo", 8 bytes as two float32: Zm9vYmFyZm8= (RFC 4648 alphabet and padding)
  float numbers[2];
  std::memcpy(numbers, "foobarfo", 8);
  EXPECT_EQ(json::base64({numbers[0], numbers[1]}), "Zm9vYmFyZm8=");
  const auto back = json::floats_from_base64("Zm9vYmFyZm8=");
  ASSERT_EQ(back.size(), 2u);
  EXPECT_EQ(back[0], numbers[0]);
  EXPECT_EQ(back[1], numbers[1]);
}

TEST(Base64, KeepsNanAndEveryLength) {
  for (size_t n = 0; n < 7; ++n) {
    std::vector<float> numbers(n, 1.5f);
    if (n > 0) numbers.back() = std::nanf("");
    const auto back = json::floats_from_base64(json::base64(numbers));
    ASSERT_EQ(back.size(), n);
    for (size_t i = 0; i + 1 < n; ++i) EXPECT_EQ(back[i], 1.5f);
    if (n > 0) {
      EXPECT_TRUE(std::isnan(back.back()));
    }
  }
}

TEST(Base64, RefusesWhatIsNoNumbers) {
  EXPECT_THAT(message_of<InputError>([] { json::floats_from_base64("A*=="); }),
              HasSubstr("unexpected character '*'"));
  EXPECT_THAT(message_of<InputError>([] { json::floats_from_base64("AAAA"); }), HasSubstr("3 bytes"));
}

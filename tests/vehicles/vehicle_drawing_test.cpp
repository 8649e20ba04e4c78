#include "vehicles/vehicle_drawing.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <regex>

#include "easydyn/error.hpp"
#include "vehicles/catalogue.hpp"

namespace {

using namespace easydyn::vehicles;
using testing::HasSubstr;

int count(const std::string& text, const std::string& pattern) {
  const std::regex regex(pattern);
  return static_cast<int>(std::distance(std::sregex_iterator(text.begin(), text.end(), regex), {}));
}

TEST(VehicleDrawing, IsClosedSvgOfTheWidthAskedFor) {
  for (const CatalogueEntry& entry : vehicle_catalogue()) {
    const std::string svg = draw_vehicle(entry.make());
    EXPECT_THAT(svg, testing::StartsWith("<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"1000\""));
    EXPECT_THAT(svg, testing::EndsWith("</svg>\n"));
    // every element is closed: by itself, or by its end
    const int elements = count(svg, "<[a-z]+[ >]"), closed = count(svg, "/>") + count(svg, "</[a-z]+>");
    EXPECT_EQ(elements, closed) << entry.name;
    EXPECT_EQ(count(svg, "\"") % 2, 0) << entry.name;
    EXPECT_THAT(svg, testing::Not(HasSubstr("nan")));
  }
}

TEST(VehicleDrawing, ShowsEveryAxleLoadOnceAndTheDimensions) {
  const std::string tram = draw_vehicle(find_vehicle("t2000_like"));
  // 66 : 34 of 10.3 t and half of 16.0 t, as tests/vehicles/axle_loads_test.cpp derives them
  EXPECT_EQ(count(tram, ">78\\.[0-9]<"), 2);
  for (const char* words : {">front body<", ">9.00 t<", ">1.70<", ">22.80<", ">8.20<", "36.50 t"})
    EXPECT_THAT(tram, HasSubstr(words));
  const std::string thalys = draw_vehicle(find_vehicle("thalys_like"));
  EXPECT_EQ(count(thalys, ">166\\.8<"), 18);  // 17 t
  EXPECT_EQ(count(thalys, ">142\\.2<"), 4);   // 14.5 t
  EXPECT_EQ(count(thalys, ">154\\.5<"), 4);   // 15.75 t
  EXPECT_EQ(count(thalys, ">3\\.00<"), 13);   // every wheelbase
  EXPECT_EQ(count(thalys, ">7\\.215<"), 2);   // overhangs 4.075 and 3.14
}

TEST(VehicleDrawing, RefusesImpossibleOptionsAndEscapesNames) {
  RailVehicle car = manchester_benchmark_1();
  EXPECT_THAT(
      [&] { draw_vehicle(car, {.width = 10}); },
      testing::ThrowsMessage<easydyn::ModelError>(HasSubstr("drawing: width = 10 px, must be >= 300")));
  car.name = "A & <B>";
  EXPECT_THAT(draw_vehicle(car), HasSubstr("A &amp; &lt;B&gt;"));
  EXPECT_THROW(write_vehicle_drawing("no/such/folder/car.svg", car), easydyn::InputError);
}

}  // namespace

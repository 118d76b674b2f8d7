// SPDX-License-Identifier: Apache-2.0
#include "io/base/json_parse.h"

#include <gtest/gtest.h>

#include "io/base/json_cursor.h"
#include "tests/support/refusal.h"

namespace petzval::io {
namespace {

const std::string kGltf = "a.gltf";

std::string refused(const std::string& text) {
    return refusal([&] { (void)parse_json(text, kGltf); });
}

std::string nested(int levels) {
    return std::string(size_t(levels), '[') + std::string(size_t(levels), ']');
}

TEST(JsonParse, LimitsDepthBeforeTheStackEnds) {
    EXPECT_NO_THROW((void)parse_json(nested(max_json_depth), kGltf));
    EXPECT_TRUE(has(refused(nested(max_json_depth + 1)), "nested more than 128"));
    EXPECT_TRUE(has(refused(nested(1'000'000)), "nested more than 128"));
    EXPECT_TRUE(has(refused(std::string(5'000'000, '[')), "nested more than 128"));
    std::string objects;
    for (int i = 0; i < 1'000'000; ++i) objects += R"({"a":)";
    EXPECT_TRUE(has(refused(objects), "nested more than 128"));
}

// A parser that looks back at each element takes minutes for this.
TEST(JsonParse, ReadsAMillionElementsOneByOne) {
    constexpr size_t count = 1'000'000;
    std::string text = "[";
    for (size_t i = 0; i < count; ++i) text += i % 2 ? "[0]," : "{},";
    text.back() = ']';
    const auto json = parse_json(text, kGltf);
    EXPECT_EQ(json.size(), count);
    EXPECT_EQ(json[0], nlohmann::json::object());
    EXPECT_EQ(json[count - 1], nlohmann::json::array({0}));
}

TEST(JsonParse, BuildsWhatIsNested) {
    const std::string text = R"({"a":[1,{"b":[],"c":{"d":null}},"x"],"e":true,"f":-0.5,"":{}})";
    EXPECT_EQ(parse_json(text, kGltf), nlohmann::json::parse(text));
    for (const char* single : {"7", "null", "\"s\"", "[]", " {} "})
        EXPECT_EQ(parse_json(single, kGltf), nlohmann::json::parse(single)) << single;
}

TEST(JsonParse, SaysWhereTheTextBreaks) {
    EXPECT_EQ(refused("{\n  \"a\": 1,\n  \"b\" 2}"),
              "a.gltf: line 3, column 7: is not valid JSON from here on");
    EXPECT_TRUE(has(refused(""), "line 1, column 1"));
    EXPECT_TRUE(has(refused("{} x"), "line 1, column 4"));
    EXPECT_TRUE(has(refused("[1,\n 1e999]"), "line 2, column 2: the number is beyond"));
    EXPECT_TRUE(has(refused("[NaN]"), "not valid JSON"));
}

TEST(JsonParse, RefusesWhatReadersDisagreeOn) {
    EXPECT_EQ(refused("{\"a\": 1, \"b\": {\"a\": 2},\n \"a\": 3}"),
              "a.gltf: line 2, column 4: the key that ends here stands in its object already");
    EXPECT_TRUE(has(refused("[\"\xFF\"]"), "not valid JSON"));
    EXPECT_NO_THROW((void)parse_json(R"([{"a": 1}, {"a": {"a": 2}}])", kGltf));
}

TEST(JsonParse, SkipsAByteOrderMark) {
    EXPECT_EQ(parse_json("\xEF\xBB\xBF{}", kGltf), nlohmann::json::object());
}

TEST(JsonParse, MakesWholeNumbersIntegers) {
    const auto json = parse_json("[3.0, -2e0, 0.25, 1e300, 18014398509481984.0]", kGltf);
    EXPECT_TRUE(json[0].is_number_integer());
    EXPECT_EQ(json[0], 3);
    EXPECT_EQ(json[1], -2);
    EXPECT_TRUE(json[1].is_number_integer());
    EXPECT_EQ(json[2], 0.25);
    EXPECT_TRUE(json[3].is_number_float());
    EXPECT_TRUE(json[4].is_number_float());
}

class Cursor : public testing::Test {
  protected:
    const nlohmann::json json = nlohmann::json::parse(R"({
        "i": 5, "minus": -1, "f": 0.5, "big": 1e40, "s": "text", "b": true, "n": null,
        "list": [1, 2, 2], "o": {"x": {"y": []}}, "objects": [{}, 7], "a/b~c": 1})");
    const JsonCursor root{json, kGltf};
};

TEST_F(Cursor, ReadsWhatIsThere) {
    EXPECT_EQ(root.integer("i"), 5u);
    EXPECT_EQ(root.integer_or("none", 9), 9u);
    EXPECT_EQ(root.number("f"), 0.5);
    EXPECT_EQ(root.number("i", {5, 5}), 5.0);
    EXPECT_EQ(root.text("s"), "text");
    EXPECT_EQ(root.numbers("list", 3), (std::vector<double>{1, 2, 2}));
    EXPECT_TRUE(root.numbers("none", 3).empty());
    EXPECT_EQ(root.index("i", 6, "thing"), 5u);
    EXPECT_EQ(root.index("none", 6, "thing"), std::nullopt);
    EXPECT_EQ(root.object("o").object("x").path(), "/o/x");
    EXPECT_EQ(root.object("o").object("x").length("y"), 0u);
    EXPECT_FALSE(root.find_object("none"));
    EXPECT_EQ(root.path_of("a/b~c"), "/a~1b~0c");
}

TEST_F(Cursor, NamesThePlaceOfEveryMismatch) {
    const auto says = [](auto action, const std::string& message) {
        EXPECT_EQ(refusal(action), message);
    };
    says([&] { (void)root.integer("s"); }, "a.gltf: /s: must be a whole number, but is string");
    says([&] { (void)root.integer("minus"); },
         "a.gltf: /minus: must be a whole number from 0 to 2^53, but is -1");
    says([&] { (void)root.integer("f"); },
         "a.gltf: /f: must be a whole number from 0 to 2^53, but is 0.5");
    says([&] { (void)root.integer("none"); }, "a.gltf: has no \"none\", which it must have");
    says([&] { (void)root.number("b"); }, "a.gltf: /b: must be a number, but is boolean");
    says(
        [&] {
            (void)root.number("f", {0, 0.25});
        },
        "a.gltf: /f: must be from 0 to 0.25, but is 0.5");
    says([&] { (void)root.text("n"); }, "a.gltf: /n: must be a string, but is null");
    says([&] { root.check_bool("i"); }, "a.gltf: /i: must be true or false, but is number");
    says([&] { (void)root.object("list"); }, "a.gltf: /list: must be an object, but is array");
    says([&] { (void)root.object("o").object("z"); },
         "a.gltf: /o: has no \"z\", which it must have");
    says([&] { (void)root.objects("s"); }, "a.gltf: /s: must be an array, but is string");
    says([&] { (void)root.objects("objects"); },
         "a.gltf: /objects/1: must be an object, but is number");
    says([&] { (void)root.numbers("list", 2); }, "a.gltf: /list: must hold 2 numbers, but holds 3");
    says(
        [&] {
            (void)root.numbers("list", 3, {0, 1});
        },
        "a.gltf: /list/1: must be from 0 to 1, but is 2");
    says([&] { (void)root.index("i", 5, "thing"); },
         "a.gltf: /i: there is no thing 5; the file has 5");
    says([&] { (void)root.indices("list", 3, "thing"); }, "a.gltf: /list/2: names thing 2 again");
    EXPECT_TRUE(has(refusal([&] { (void)root.number("big"); }), "/big: must be from"));
    EXPECT_TRUE(has(refusal([&] { JsonCursor(json["list"], kGltf); }), "must be an object"));
}

}  // namespace
}  // namespace petzval::io

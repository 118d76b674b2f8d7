// SPDX-License-Identifier: Apache-2.0
#include "io/base/uri.h"

#include <gtest/gtest.h>

#include <random>

#include "tests/support/tiny_gltf.h"

namespace petzval::io {
namespace {

using Bytes = std::vector<uint8_t>;

// RFC 4648, section 10, test vectors.
TEST(Base64, DecodesTheStandardsExamples) {
    const std::pair<const char*, std::string> cases[] = {{"", ""},
                                                         {"Zg==", "f"},
                                                         {"Zm8=", "fo"},
                                                         {"Zm9v", "foo"},
                                                         {"Zm9vYg==", "foob"},
                                                         {"Zm9vYmE=", "fooba"},
                                                         {"Zm9vYmFy", "foobar"},
                                                         {"Zm9vYmE", "fooba"}};
    for (const auto& [text, expected] : cases)
        EXPECT_EQ(decode_base64(text), Bytes(expected.begin(), expected.end())) << text;
}

TEST(Base64, RefusesForeignCharactersAndImpossibleLengths) {
    for (const char* text : {"Z", "Zm9vY", "Zm9`", "Z=g=", "==="})
        EXPECT_FALSE(decode_base64(text)) << text;
}

TEST(Base64, TakesLineBreaksAndTheAlphabetOfAddresses) {
    EXPECT_EQ(decode_base64("Zm9v\r\nYmE=\n"), decode_base64("Zm9vYmE="));
    EXPECT_EQ(decode_base64("-_-_"), decode_base64("+/+/"));
}

TEST(Base64, InvertsTheEncoder) {
    std::mt19937 random(1);
    for (size_t size = 0; size < 200; ++size) {
        Bytes bytes(size);
        for (uint8_t& byte : bytes) byte = uint8_t(random());
        EXPECT_EQ(decode_base64(base64(bytes)), bytes);
        EXPECT_EQ(encode_base64(bytes), base64(bytes));
    }
}

TEST(DataUri, GivesTypeAndBytes) {
    const auto data = parse_data_uri("data:Image/PNG;charset=x;base64,Zm9v");
    ASSERT_TRUE(data);
    EXPECT_EQ(data->mime_type, "image/png");
    EXPECT_EQ(data->bytes, (Bytes{'f', 'o', 'o'}));
    ASSERT_TRUE(parse_data_uri("DATA:;base64,"));
    EXPECT_EQ(parse_data_uri("data:;base64,")->mime_type, "");
}

TEST(DataUri, RefusesWhatIsNotBase64) {
    for (const char* uri : {"data:", "data:,abc", "data:text/plain,abc", "data:image/png;base64",
                            "data:image/png;base64,`", "file.png"})
        EXPECT_FALSE(parse_data_uri(uri)) << uri;
}

TEST(RelativePath, DecodesPercentEscapes) {
    EXPECT_EQ(relative_path("a%20b/%c3%A4.png"), "a b/\xC3\xA4.png");
    EXPECT_EQ(relative_path("../textures/a.png"), "../textures/a.png");
    EXPECT_EQ(relative_path("a/b:c.png"), "a/b:c.png");
    EXPECT_EQ(relative_path("textures\\a.png"), "textures/a.png");
    for (const char* odd : {"a%2.png", "a%zz.png", "a%", "100 %.png"})
        EXPECT_EQ(relative_path(odd), odd);
}

TEST(RelativePath, RefusesAddresses) {
    for (const char* uri : {"", "/etc/passwd", "//host/a.png", "http://host/a.png", "file:a.png",
                            "C:/a.png", ":", "%2Fetc/passwd", "\\etc\\passwd", "a%00.png"})
        EXPECT_FALSE(relative_path(uri)) << uri;
}

}  // namespace
}  // namespace petzval::io

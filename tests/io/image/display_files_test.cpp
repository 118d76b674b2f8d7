// SPDX-License-Identifier: Apache-2.0
#include "io/image/display_files.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <fstream>

#include "io/base/error.h"
#include "io/image/display.h"
#include "tests/support/ocio_config.h"
#include "tests/support/temporary_folder.h"

namespace petzval::io {
namespace {

class DisplayFiles : public ::testing::Test {
  protected:
    test::TemporaryFolder folder_;

    std::filesystem::path write(const std::string& name, const std::string& text) const {
        std::ofstream(folder_ / name, std::ios::binary) << text;
        return folder_ / name;
    }
    /// A configuration whose named transform reads a table.
    std::filesystem::path config_with(const std::string& table) const {
        return write("c.ocio", test::aces_config() +
                                   "named_transforms:\n  - !<NamedTransform>\n    name: Named\n"
                                   "    transform: !<FileTransform> {src: " +
                                   table + "}\n");
    }
    static std::string ctf(const std::string& before, const std::string& path) {
        return "<?xml version=\"1.0\"?>\n" + before +
               "<ProcessList id=\"a\" version=\"1.4\">\n<Reference\n  inBitDepth=\"32f\" "
               "outBitDepth=\"32f\" path = '" +
               path + "'/>\n</ProcessList>\n";
    }
    static std::string complaint(const std::filesystem::path& config) {
        try {
            static_cast<void>(display_views(config));
            return "";
        } catch (const InputError& error) {
            return error.what();
        }
    }
};

using Files = std::vector<std::filesystem::path>;
constexpr const char* kTable =
    "Version 1\nFrom 0.0 1.0\nLength 2\nComponents 1\n{\n 0.0\n 0.5\n}\n";

TEST_F(DisplayFiles, NamedTransformsAndWhatTheirTablesReferTo) {
    const auto c = config_with("a.ctf"), a = write("a.ctf", ctf("", "b.ctf")),
               b = write("b.ctf", ctf("", "t.spi1d")), t = write("t.spi1d", kTable);
    EXPECT_EQ(display_files(c), (Files{c, a, b, t}));
    write("b.ctf", ctf("", "a.ctf"));  // in a circle
    EXPECT_EQ(display_files(c), (Files{c, a, b}));
    write("b.ctf", ctf("", "none.ctf"));
    EXPECT_EQ(display_files(c), (Files{c, a, b}));
    write("b.ctf", std::string(9000, ' ') + ctf("", "t.spi1d").substr(22));
    EXPECT_EQ(display_files(c), (Files{c, a, b, t}));
}

// Nobody writes to the pipe: who opens it would wait for ever.
TEST_F(DisplayFiles, PipesAreRefusedHoweverTheyAreNamed) {
    const auto pipe = folder_ / "pipe.spi1d";
    ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
    const std::string why = "names " + pipe.string() + ", which is not a regular file";
    EXPECT_NE(complaint(pipe).find("is not a regular file"), std::string::npos);
    EXPECT_NE(complaint(config_with("pipe.spi1d")).find(why), std::string::npos);
    write("a.ctf", ctf("", "pipe.spi1d"));
    EXPECT_NE(complaint(config_with("a.ctf")).find(why), std::string::npos);
    std::string wide = "\xFF\xFE", latin = ctf("", "\xE9.spi1d");
    for (const char letter : ctf("", "pipe.spi1d")) wide.append({letter, '\0'});
    latin.insert(latin.find("?>"), " encoding=\"ISO-8859-1\"");
    for (const std::string& text : {ctf("<!DOCTYPE x [<!ENTITY p \"pipe.spi1d\">]>", "t.spi1d"),
                                    ctf("", "&#112;ipe.spi1d"), wide, latin}) {
        write("a.ctf", text);
        EXPECT_NE(complaint(config_with("a.ctf")).find("save it as plain UTF-8"), std::string::npos)
            << text;
    }
}

}  // namespace
}  // namespace petzval::io

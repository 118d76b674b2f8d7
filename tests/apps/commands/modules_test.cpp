// SPDX-License-Identifier: Apache-2.0
// The module that holds the image library: loaded where a picture is met, and missed by name.
#include <gmock/gmock.h>

#include <cstdlib>

#include "tests/support/cli.h"

namespace petzval::apps {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class CliModules : public CliTest {
  protected:
    /// A copy of the program in a folder bin, without its modules.
    [[nodiscard]] std::string installed_program() const {
        std::filesystem::create_directories(path("there/bin"));
        std::filesystem::create_directories(path("there/share"));
        std::filesystem::create_symlink(PETZVAL_ASSETS, path("there/share/petzval"));
        std::filesystem::copy_file(PETZVAL_PROGRAM, path("there/bin/petzval"));
        return path("there/bin/petzval");
    }
};

// The dynamic linker lists a program's libraries in place of running it.
TEST_F(CliModules, TheProgramStartsWithoutTheImageLibrary) {
    const Finished run =
        Process({"LD_TRACE_LOADED_OBJECTS=1", PETZVAL_PROGRAM}, {}, "/usr/bin/env").wait();
    EXPECT_THAT(run.out, AllOf(HasSubstr("libembree"), Not(HasSubstr("libOpenImageIO"))));
}

TEST_F(CliModules, AMissingModuleIsNamedOnceAPictureIsMet) {
    const std::string program = installed_program();
    EXPECT_EQ(Process({"--version"}, {}, program).wait().exit_code, 0);
    EXPECT_EQ(Process({"lens", "list"}, {}, program).wait().exit_code, 0);
    const Words render = render_words({"-o", path("out.exr"), "--quiet"}, scene_);
    for (const Words& words :
         {render, Words{"image", "view", path("a.exr"), "-o", path("b.png")}}) {
        const Finished run = Process(words, {}, program).wait();
        EXPECT_THAT(only_line(run, 1),
                    AllOf(HasSubstr("petzval_io_codec.so"), HasSubstr("cmake --install")));
    }
}

// It must not be found out after the work.
TEST_F(CliModules, AModuleThatCannotBeLoadedStopsARenderBeforeItBegins) {
    const std::string program = installed_program();
    const std::filesystem::path folder =
        std::filesystem::path(PETZVAL_PROGRAM).parent_path().parent_path();
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder / "lib")) {
        if (entry.path().filename() != "petzval_io_codec.so") continue;
        const std::filesystem::path copy = path("there") / entry.path().lexically_relative(folder);
        std::filesystem::create_directories(copy.parent_path());
        std::ofstream(copy) << "no library";
    }
    const Finished run =
        Process(render_words({"--spp", "1000000", "-o", path("out.exr")}, scene_), {}, program)
            .wait();
    EXPECT_EQ(run.exit_code, 1);
    EXPECT_THAT(run.err, AllOf(HasSubstr("petzval_io_codec.so"), HasSubstr("cmake --install")));
    const Words chart{"chart",  scene_,  "--axis", "sampler",
                      "--size", "16x16", "-o",     path("report")};
    EXPECT_THAT(only_line(Process(chart, {}, program).wait(), 1), HasSubstr("petzval_io_codec.so"));
}

}  // namespace
}  // namespace petzval::apps

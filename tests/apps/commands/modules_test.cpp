// SPDX-License-Identifier: Apache-2.0
// The module that holds the image library: loaded where a picture is met, and missed by name.
#include <gmock/gmock.h>

#include <cstdlib>

#include "tests/support/cli.h"

namespace petzval {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class CliModules : public CliTest {};

// The dynamic linker lists a program's libraries in place of running it.
TEST_F(CliModules, TheProgramStartsWithoutTheImageLibrary) {
    const Finished run =
        Process({"LD_TRACE_LOADED_OBJECTS=1", PETZVAL_PROGRAM}, {}, "/usr/bin/env").wait();
    EXPECT_THAT(run.out, AllOf(HasSubstr("libembree"), Not(HasSubstr("libOpenImageIO"))));
}

TEST_F(CliModules, AMissingModuleIsNamedOnceAPictureIsMet) {
    const std::string program = path("petzval");
    std::filesystem::copy_file(PETZVAL_PROGRAM, program);
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

}  // namespace
}  // namespace petzval

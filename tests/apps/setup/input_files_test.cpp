// SPDX-License-Identifier: Apache-2.0
#include "apps/setup/input_files.h"

#include <gtest/gtest.h>

#include "io/base/error.h"

namespace petzval::apps {
namespace {

// Not by way of the program: where it failed, the file would be lost.
TEST(InputFiles, ThoseOfPetzvalItselfAreAmongThem) {
    for (const char* name : {"/color/config.ocio", "/glass/catalog.csv", "/spectra/d65.csv",
                             "/lenses/tessar-100mm-f2.8.json"})
        EXPECT_THROW(
            io::refuse_overwriting({{"--stats", std::string(PETZVAL_ASSETS) + name}}, own_files()),
            io::ArgumentError)
            << name;
    EXPECT_NO_THROW(io::refuse_overwriting(
        {{"--stats", std::string(PETZVAL_ASSETS) + "/spectra/none.csv"}}, own_files()));
}

}  // namespace
}  // namespace petzval::apps

// SPDX-License-Identifier: Apache-2.0
#include "io/file/assets.h"

#include <system_error>

#include "io/base/error.h"
#include "io/file/program_file.h"

namespace petzval {

std::filesystem::path asset(const std::string& relative) {
    namespace fs = std::filesystem;
    std::error_code error;
    const fs::path installed = file_beside_program(fs::path(PETZVAL_ASSETS_FROM_BIN) / relative);
    if (fs::exists(installed, error)) return installed;
    const fs::path in_source = fs::path(PETZVAL_SOURCE_ASSETS) / relative;
    if (fs::exists(in_source, error)) return in_source;
    throw InputError(installed.string(), "",
                     "is missing; install Petzval again with cmake --install");
}

}  // namespace petzval

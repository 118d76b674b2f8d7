// SPDX-License-Identifier: Apache-2.0
#include "io/file/assets.h"

#include <system_error>

#include "io/base/error.h"
#include "io/file/program_file.h"

namespace petzval::io {

std::filesystem::path asset(const std::string& relative) {
    std::filesystem::path there =
        installed_file(std::filesystem::path(PETZVAL_ASSETS_FROM_BIN) / relative);
    std::error_code error;
    if (std::filesystem::exists(there, error)) return there;
    throw InputError(there.string(), "", "is missing; install Petzval again with cmake --install");
}

}  // namespace petzval::io

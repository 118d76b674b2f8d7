// SPDX-License-Identifier: Apache-2.0
#include "io/file/program_file.h"

#include <sys/auxv.h>

#include <system_error>

#include "io/base/error.h"

// Folder of Petzval's own program, in those that PetzvalConfig.cmake gives this function.
extern "C" [[gnu::weak]] const char* petzval_installed_bin();

namespace petzval::io {
namespace {

namespace fs = std::filesystem;

// Without /proc it is the name by which the program was started.
fs::path own_folder() {
    std::error_code error;
    const fs::path linked = fs::read_symlink("/proc/self/exe", error);
    if (!error) return linked.parent_path();
    const auto* const started = reinterpret_cast<const char*>(::getauxval(AT_EXECFN));
    const fs::path named = fs::canonical(started ? started : "", error);
    if (!error) return named.parent_path();
    throw InputError("/proc/self/exe", "",
                     "cannot be read, and with it not found what is installed beside the program; "
                     "mount /proc");
}

}  // namespace

fs::path installed_file(const fs::path& relative) {
    std::error_code error;
    if (petzval_installed_bin) {
        fs::path installed = (fs::path(petzval_installed_bin()) / relative).lexically_normal();
        if (fs::exists(installed, error)) return installed;
    }
    return (own_folder() / relative).lexically_normal();
}

}  // namespace petzval::io

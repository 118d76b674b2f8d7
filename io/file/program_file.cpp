// SPDX-License-Identifier: Apache-2.0
#include "io/file/program_file.h"

#include <system_error>

namespace petzval {

std::filesystem::path file_beside_program(const std::filesystem::path& relative) {
    std::error_code error;
    const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", error);
    return error ? std::filesystem::path{} : (program.parent_path() / relative).lexically_normal();
}

}  // namespace petzval

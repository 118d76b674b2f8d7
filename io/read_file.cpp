// SPDX-License-Identifier: Apache-2.0
#include "io/read_file.h"

#include <fstream>

namespace petzval {

FileBytes read_file(const std::filesystem::path& path) {
    namespace fs = std::filesystem;
    std::error_code code;
    const fs::file_status status = fs::status(path, code);
    if (status.type() == fs::file_type::not_found) return {{}, "no such file"};
    if (code) return {{}, code.message()};
    if (status.type() == fs::file_type::directory) return {{}, "is a folder"};
    if (status.type() != fs::file_type::regular) return {{}, "is not a regular file"};

    const uintmax_t size = fs::file_size(path, code);
    if (code) return {{}, code.message()};
    std::ifstream in(path, std::ios::binary);
    if (!in) return {{}, "cannot be opened"};
    FileBytes file;
    file.bytes.resize(size);
    in.read(reinterpret_cast<char*>(file.bytes.data()), std::streamsize(size));
    if (uintmax_t(in.gcount()) != size) return {{}, "cannot be read to its end"};
    return file;
}

}  // namespace petzval

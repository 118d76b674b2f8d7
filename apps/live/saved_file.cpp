// SPDX-License-Identifier: Apache-2.0
#include "apps/live/saved_file.h"

#include <stdlib.h>

#include <memory>

#include "apps/request/value_error.h"
#include "io/base/error.h"
#include "io/file/read_file.h"

namespace petzval {

namespace fs = std::filesystem;

std::string saved_file(const std::string& name, const std::function<void(const fs::path&)>& write) {
    const fs::path file = name;
    if (file != file.filename() ||
        (file.extension() != ".exr" && file.extension() != ".png" && file.extension() != ".jpg"))
        throw ValueError("name", "is no name of a picture: it ends in .exr, .png or .jpg");
    std::string pattern = (fs::temp_directory_path() / "petzval-XXXXXX").string();
    if (!mkdtemp(pattern.data()))
        throw OutputError(pattern, "", "cannot be made; TMPDIR names a folder with room");
    const fs::path folder = pattern;
    const auto remove = [](const fs::path* path) {
        std::error_code ignored;
        fs::remove_all(*path, ignored);
    };
    const std::unique_ptr<const fs::path, decltype(remove)> guard(&folder, remove);
    write(folder / file);
    const FileBytes bytes = read_file(folder / file);
    if (!bytes.error.empty()) throw InputError((folder / file).string(), "", bytes.error);
    return {bytes.bytes.begin(), bytes.bytes.end()};
}

}  // namespace petzval

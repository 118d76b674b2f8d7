// SPDX-License-Identifier: Apache-2.0
#include "apps/live/saved_file.h"

#include <stdlib.h>

#include "apps/request/value_error.h"
#include "io/base/error.h"
#include "io/file/read_file.h"

namespace petzval::apps {

namespace fs = std::filesystem;

OwnFolder::OwnFolder() {
    std::error_code none;
    std::string pattern = (fs::temp_directory_path(none) / "petzval-XXXXXX").string();
    if (none || !mkdtemp(pattern.data()))
        throw io::OutputError("the folder of temporary files", "",
                              "has no room; set TMPDIR to one that has, and start again");
    path_ = pattern;
}

OwnFolder::~OwnFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
}

std::string saved_file(const std::string& name, const std::function<void(const fs::path&)>& write) {
    const fs::path file = name;
    if (file != file.filename() ||
        (file.extension() != ".exr" && file.extension() != ".png" && file.extension() != ".jpg"))
        throw ValueError("name", "is no name of a picture: it ends in .exr, .png or .jpg");
    const OwnFolder folder;
    write(folder.path() / file);
    const io::FileBytes bytes = io::read_file(folder.path() / file);
    if (!bytes.error.empty()) throw io::InputError(name, "", bytes.error);
    return {bytes.bytes.begin(), bytes.bytes.end()};
}

}  // namespace petzval::apps

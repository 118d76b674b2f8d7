// SPDX-License-Identifier: Apache-2.0
#include "io/file/overwrite.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <optional>
#include <utility>

#include "io/base/error.h"

namespace petzval::io {
namespace {

namespace fs = std::filesystem;

/// The place of a file that is not there yet: its folder without links, and what it will be called.
fs::path place_of(fs::path path) {
    constexpr int kMaxLinks = 40;  // Linux's own limit
    std::error_code error;
    for (int i = 0; i < kMaxLinks && fs::is_symlink(path, error); ++i)
        path = path.parent_path() / fs::read_symlink(path, error);
    const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
    return fs::weakly_canonical(folder, error) / path.filename();
}

/// What tells one file from another.
struct Identity {
    std::optional<std::pair<dev_t, ino_t>> inode;  ///< of a file that is there
    fs::path place;                                ///< of one that is not
    bool counts = true;

    explicit Identity(const fs::path& path) {
        struct stat status {};
        if (::stat(path.c_str(), &status) == 0) {
            inode = {status.st_dev, status.st_ino};
            counts = !S_ISCHR(status.st_mode);
        } else {
            place = place_of(path);
        }
    }
    [[nodiscard]] bool operator==(const Identity& o) const {
        return counts && o.counts && inode == o.inode && (inode || place == o.place);
    }
};

}  // namespace

bool same_file(const fs::path& a, const fs::path& b) {
    return Identity(a) == Identity(b);
}

void refuse_overwriting(const std::vector<NamedFile>& outputs,
                        const std::vector<NamedFile>& inputs) {
    std::vector<std::pair<Identity, const NamedFile*>> written;
    for (const NamedFile& output : outputs) {
        const Identity identity(output.path);
        for (const auto& [before, other] : written)
            if (before == identity)
                throw ArgumentError(output.path.string(), "",
                                    "{} would overwrite what {} writes ({}); give "
                                    "each a name of its own",
                                    output.role, other->role, other->path.string());
        written.emplace_back(identity, &output);
    }
    for (const NamedFile& input : inputs) {
        const Identity identity(input.path);
        for (const auto& [of_output, output] : written)
            if (of_output == identity)
                throw ArgumentError(output->path.string(), "",
                                    "{} would overwrite {} ({}); give another name", output->role,
                                    input.role, input.path.string());
    }
}

}  // namespace petzval::io

// SPDX-License-Identifier: Apache-2.0
#include "io/file/rescue.h"

#include <stdlib.h>

#include <exception>
#include <new>
#include <optional>

#include "io/base/error.h"
#include "io/file/atomic_file.h"

namespace petzval::io {
namespace {

namespace fs = std::filesystem;

/// What the action threw; nothing where it threw nothing.
std::optional<std::string> error_of(const std::function<void()>& action) {
    try {
        action();
    } catch (const std::bad_alloc&) {
        return "out of memory";
    } catch (const std::exception& error) {
        return error.what();
    }
    return std::nullopt;
}

/// Name in a folder that nothing has yet, not even a link to nothing.
fs::path free_name(const fs::path& folder, const fs::path& wanted) {
    const std::string stem = wanted.stem().string() + ".rescue",
                      ending = wanted.extension().string();
    fs::path path = folder / (stem + ending);
    std::error_code error;
    for (int i = 2; fs::symlink_status(path, error).type() != fs::file_type::not_found; ++i) {
        if (error) break;
        path = folder / (stem + "-" + std::to_string(i) + ending);
    }
    return path;
}

/// A new folder that only this user may enter; an empty path where there can be none.
fs::path new_temporary_folder() {
    std::error_code error;
    std::string name = (fs::temp_directory_path(error) / "petzval-rescue-XXXXXX").string();
    return error || ::mkdtemp(name.data()) == nullptr ? fs::path() : fs::path(name);
}

}  // namespace

std::string WriteOutcome::message() const {
    return error + (rescue.empty() ? "; no copy could be kept elsewhere either"
                                   : "; a copy is in " + rescue.string());
}

WriteOutcome write_or_rescue(const fs::path& wanted,
                             const std::function<void(const fs::path&)>& write) {
    WriteOutcome out{wanted, error_of([&] { write(wanted); }).value_or(""), {}};
    if (out.written()) return out;
    const auto keep_in = [&](const fs::path& folder) {
        const fs::path path = free_name(folder, wanted);
        if (!error_of([&] { write(path); })) out.rescue = path;
        return !out.rescue.empty();
    };
    std::error_code error;
    if (!is_stream(wanted) && keep_in(wanted.parent_path())) return out;
    if (const fs::path here = fs::current_path(error); !error && keep_in(here)) return out;
    if (const fs::path folder = new_temporary_folder(); !folder.empty() && !keep_in(folder))
        fs::remove(folder, error);
    return out;
}

void attempt_all(const std::vector<std::function<void()>>& actions) {
    std::string messages;
    std::exception_ptr first;
    int failed = 0;
    for (const auto& action : actions) try {
            action();
        } catch (const std::exception& error) {
            messages += (failed++ > 0 ? "; " : "") + std::string(error.what());
            if (!first) first = std::current_exception();
        }
    if (failed == 1) std::rethrow_exception(first);
    if (failed > 1) throw OutputError(messages);
}

}  // namespace petzval::io

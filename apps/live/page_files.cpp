// SPDX-License-Identifier: Apache-2.0
#include "apps/live/page_files.h"

#include <array>
#include <filesystem>

#include "io/base/error.h"
#include "io/file/assets.h"
#include "io/file/read_file.h"

namespace petzval::apps {

std::map<std::string, PageFile> read_page_files() {
    constexpr std::array<std::array<const char*, 2>, 4> kTypes{
        {{".html", "text/html; charset=utf-8"},
         {".js", "text/javascript; charset=utf-8"},
         {".css", "text/css; charset=utf-8"},
         {".svg", "image/svg+xml"}}};
    std::map<std::string, PageFile> out;
    for (const auto& entry : std::filesystem::directory_iterator(io::asset("live")))
        for (const auto& [ending, type] : kTypes)
            if (entry.path().extension() == ending) {
                const io::FileBytes file = io::read_file(entry.path());
                if (!file.error.empty())
                    throw io::InputError(entry.path().string(), "", file.error);
                out[entry.path().filename().string()] = {
                    type, std::string(file.bytes.begin(), file.bytes.end())};
            }
    return out;
}

}  // namespace petzval::apps

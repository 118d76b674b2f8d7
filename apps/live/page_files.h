// SPDX-License-Identifier: Apache-2.0
// Files of the page, assets/live, in memory: no path of a request ever reaches the disk.
#pragma once

#include <map>
#include <string>

namespace petzval::apps {

struct PageFile {
    std::string type, bytes;  ///< type: of media, as HTTP names it
};

/// Files of the page by their names, "index.html" among them. Throws InputError where they are
/// missing.
[[nodiscard]] std::map<std::string, PageFile> read_page_files();

}  // namespace petzval::apps

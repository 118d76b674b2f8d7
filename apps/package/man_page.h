// SPDX-License-Identifier: Apache-2.0
// Manual pages from the table that --help prints.
#pragma once

#include <map>
#include <string>

namespace CLI {
class App;
}

namespace petzval::apps {

/// Manual pages in roff (man(7)) by the names of their files: petzval.1, and petzval-render.1 and
/// the like for each command. Commands of a command are sections of its page.
[[nodiscard]] std::map<std::string, std::string> man_pages(const CLI::App&,
                                                           const std::string& version);

}  // namespace petzval::apps

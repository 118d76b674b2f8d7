// SPDX-License-Identifier: Apache-2.0
#include "apps/cli/readers.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

namespace petzval::apps {
namespace {

// Reader that leaves what `parse` makes of a text.
template <class Parse>
CLI::Validator reader(const Parse& parse) {
    return {[=](std::string& text) -> std::string {
                try {
                    text = fmt::format("{}", parse(text));
                    return "";
                } catch (const ValueError& error) {
                    return error.why();
                }
            },
            ""};
}

}  // namespace

CLI::Validator number_between(double least, double most, std::span<const Unit> units) {
    return reader([=](const std::string& text) {
        return parse_number("", text, {least, most, units});
    });
}

CLI::Validator whole_number_between(uint64_t least, uint64_t most) {
    return reader(
        [=](const std::string& text) { return parse_whole_number("", text, least, most); });
}

}  // namespace petzval::apps

// SPDX-License-Identifier: Apache-2.0
#include "apps/cli/old_spellings.h"

#include <array>
#include <string_view>

namespace petzval {
namespace {

struct Renamed {
    std::string_view before, now;
};
constexpr std::array<Renamed, 2> kOptions{
    {{"--chroma", "--dispersion"}, {"--march", "--lens-precision"}}};
struct RenamedValue {
    std::string_view option, before, now;
};
constexpr std::array<RenamedValue, 2> kValues{
    {{"--spectral", "hero", "wavelengths"}, {"--axis", "chroma", "dispersion"}}};

std::string current_value(std::string_view option, std::string_view value) {
    for (const RenamedValue& one : kValues)
        if (one.option == option && one.before == value) return std::string(one.now);
    return std::string(value);
}

}  // namespace

Spelling with_current_spellings(int argc, const char* const* argv) {
    Spelling out;
    std::string last_option;
    for (int i = 1; i < argc; ++i) {
        const std::string_view word(argv[i]);
        if (!word.starts_with("--")) {
            out.words.push_back(current_value(last_option, word));
            last_option.clear();
            continue;
        }
        const size_t equals = word.find('=');
        last_option = word.substr(0, equals);
        for (const Renamed& one : kOptions) {
            if (one.before != last_option) continue;
            out.renamed.emplace_back(one.before, one.now);
            last_option = one.now;
        }
        if (equals == std::string_view::npos)
            out.words.push_back(last_option);
        else
            out.words.push_back(last_option + "=" +
                                current_value(last_option, word.substr(equals + 1)));
    }
    return out;
}

}  // namespace petzval

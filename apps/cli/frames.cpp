// SPDX-License-Identifier: Apache-2.0
#include "apps/cli/frames.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "apps/cli/quantity.h"

namespace petzval {

std::vector<int> parse_frames(const std::string& option, const std::string& text) {
    constexpr int kMostFrames = 100'000, kLastFrame = 10'000'000;
    std::vector<int> numbers;
    for (const std::string_view part : split(text, ':'))
        numbers.push_back(number<int>(trimmed(part)).value_or(-1));
    const bool right =
        numbers.size() <= 3 && std::all_of(numbers.begin(), numbers.end(),
                                           [](int n) { return n >= 0 && n <= kLastFrame; });
    const int first = numbers[0], last = numbers.size() > 1 ? numbers[1] : first,
              step = numbers.size() > 2 ? numbers[2] : 1;
    if (!right || last < first || step < 1 || (last - first) / step >= kMostFrames)
        throw CLI::ValidationError(
            option, fmt::format("\"{}\" is not a range of frames such as 1:48, 1:48:2 or 7, {} at "
                                "most",
                                text, kMostFrames));
    std::vector<int> frames;
    for (int frame = first; frame <= last; frame += step) frames.push_back(frame);
    return frames;
}

std::filesystem::path name_of_frame(const std::string& option, const std::filesystem::path& path,
                                    int frame, bool several) {
    const std::string name = path.filename().string();
    const size_t end = name.find_last_of('#');
    if (end == name.npos) {
        if (!several) return path;
        throw CLI::ValidationError(
            option,
            fmt::format("\"{}\" names one file for all frames; put #### where their numbers "
                        "go",
                        path.string()));
    }
    const size_t before = name.find_last_not_of('#', end);
    const size_t begin = before == name.npos ? 0 : before + 1;
    return path.parent_path() / fmt::format("{}{:0{}}{}", name.substr(0, begin), frame,
                                            end + 1 - begin, name.substr(end + 1));
}

}  // namespace petzval

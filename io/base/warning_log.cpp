// SPDX-License-Identifier: Apache-2.0
#include "io/base/warning_log.h"

#include <fmt/format.h>

namespace petzval::io {
namespace {

bool is_digit(char c) {
    return c >= '0' && c <= '9';
}

// The line with one mark for each number and each quoted word.
std::string shape_of(std::string_view line) {
    std::string shape;
    for (size_t i = 0; i < line.size();) {
        const size_t start = i;
        if (line[i] == '-' && i + 1 < line.size() && is_digit(line[i + 1])) ++i;
        while (i < line.size() && (is_digit(line[i]) || (i > start && line[i] == '.'))) ++i;
        if (i > start) {
            shape += '#';
            continue;
        }
        if (const size_t end = line[i] == '"' ? line.find('"', i + 1) : line.npos; end != line.npos)
            i = end;
        shape += line[i++];
    }
    return shape;
}

}  // namespace

void WarningLog::push_back(std::string line) {
    const auto [at, is_new] = by_shape_.try_emplace(shape_of(line), first_.size());
    if (!is_new) {
        ++more_[at->second];
        return;
    }
    first_.push_back(std::move(line));
    more_.push_back(0);
}

std::vector<std::string> WarningLog::lines() const {
    std::vector<std::string> out = first_;
    for (size_t i = 0; i < out.size(); ++i)
        if (more_[i] > 0) out[i] += fmt::format(" (and {} more like it)", more_[i]);
    return out;
}

}  // namespace petzval::io

// SPDX-License-Identifier: Apache-2.0
#include "io/base/machine.h"

#include <sched.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <functional>
#include <optional>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

namespace petzval::io {
namespace {

namespace fs = std::filesystem;

/// Whole number at the start of a text; nothing for "max" and for numbers below 0.
std::optional<uint64_t> number_in(std::string_view text) {
    uint64_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc() && end != text.data() ? std::optional(value) : std::nullopt;
}

/// Words of the first line of a file; none where it cannot be read.
std::vector<std::string> first_words(const fs::path& file) {
    std::ifstream in(file);
    std::string line, word;
    std::getline(in, line);
    std::istringstream words(line);
    std::vector<std::string> out;
    while (words >> word) out.push_back(word);
    return out;
}

std::optional<uint64_t> number_of(const fs::path& file) {
    const auto words = first_words(file);
    return words.empty() ? std::nullopt : number_in(words[0]);
}

bool is_listed(const std::string& word, std::string_view list) {
    std::istringstream words{std::string(list)};
    for (std::string one; std::getline(words, one, ',');)
        if (one == word) return true;
    return false;
}

/// Group of this process in the hierarchy of a controller of version 1, or, for "", of version 2;
/// nothing where there is none. Linux, cgroups(7), "/proc/pid/cgroup".
std::optional<std::string> group_of_process(const fs::path& root, const std::string& controller) {
    std::ifstream in(root / "proc/self/cgroup");
    for (std::string line; std::getline(in, line);) {
        const size_t first = line.find(':'), second = line.find(':', first + 1);
        if (second == line.npos) continue;
        const std::string_view list = std::string_view(line).substr(first + 1, second - first - 1);
        if (controller.empty() ? list.empty() : is_listed(controller, list))
            return line.substr(second + 1);
    }
    return std::nullopt;
}

/// A mounted hierarchy of groups.
struct Mount {
    std::string shown;  ///< the group that is seen at the mount point
    std::string point;
};

/// Mount of a hierarchy. Linux, proc(5), "/proc/pid/mountinfo".
std::optional<Mount> find_mount(const fs::path& root, const std::string& controller) {
    std::ifstream in(root / "proc/self/mountinfo");
    for (std::string line; std::getline(in, line);) {
        const size_t dash = line.find(" - ");
        if (dash == line.npos) continue;
        std::istringstream before(line.substr(0, dash)), after(line.substr(dash + 3));
        std::string skipped, type, options;
        Mount mount;
        before >> skipped >> skipped >> skipped >> mount.shown >> mount.point;
        after >> type >> skipped >> options;
        if (controller.empty() ? type == "cgroup2"
                               : type == "cgroup" && is_listed(controller, options))
            return mount;
    }
    return std::nullopt;
}

/// Calls use(folder) for the group of this process and each above it that can be seen.
void each_group(const fs::path& root, const std::string& controller,
                const std::function<void(const fs::path&)>& use) {
    const auto group = group_of_process(root, controller);
    const auto mount = find_mount(root, controller);
    if (!group || !mount) return;
    const fs::path point = root / fs::path(mount->point).relative_path();
    // In a container the mount may show the group as its own top.
    fs::path below = fs::path(*group).lexically_relative(mount->shown);
    if (below.empty() || *below.begin() == "..") below = ".";
    for (fs::path at = (point / below).lexically_normal();; at = at.parent_path()) {
        use(at);
        if (at.lexically_relative(point) == "." || !at.has_relative_path() ||
            at == at.parent_path())
            return;
    }
}

/// Processors' worth of time that the control groups allow; nothing without a limit.
std::optional<double> cpu_quota(const fs::path& root) {
    std::optional<double> least;
    const auto allow = [&](std::optional<uint64_t> quota, std::optional<uint64_t> period) {
        if (!quota || !period || *quota == 0 || *period == 0) return;
        const double share = double(*quota) / double(*period);
        least = std::min(least.value_or(share), share);
    };
    each_group(root, "", [&](const fs::path& group) {
        const auto words = first_words(group / "cpu.max");
        if (words.size() == 2) allow(number_in(words[0]), number_in(words[1]));
    });
    each_group(root, "cpu", [&](const fs::path& group) {
        allow(number_of(group / "cpu.cfs_quota_us"), number_of(group / "cpu.cfs_period_us"));
    });
    return least;
}

/// Processors in the affinity mask; 0 where the system does not say.
int processors_in_mask() {
    constexpr int most = 1 << 16;
    for (int count = 1024; count <= most;
         count *= 2) {  // the mask must be as large as the kernel's
        cpu_set_t* const mask = CPU_ALLOC(count);
        if (!mask) return 0;
        const size_t size = CPU_ALLOC_SIZE(count);
        const int processors = sched_getaffinity(0, size, mask) == 0 ? CPU_COUNT_S(size, mask) : 0;
        CPU_FREE(mask);
        if (processors > 0) return processors;
    }
    return 0;
}

}  // namespace

int usable_threads(const fs::path& root) {
    int threads = processors_in_mask();
    if (threads == 0) threads = static_cast<int>(std::thread::hardware_concurrency());
    if (const auto quota = cpu_quota(root); quota && *quota < threads)
        threads = static_cast<int>(std::ceil(*quota));
    return std::max(threads, 1);
}

uint64_t usable_memory_bytes(const fs::path& root) {
    uint64_t least = uint64_t(sysconf(_SC_PHYS_PAGES)) * uint64_t(sysconf(_SC_PAGESIZE));
    const auto allow = [&](std::optional<uint64_t> limit) {
        if (limit) least = std::min(least, *limit);
    };
    each_group(root, "", [&](const fs::path& group) { allow(number_of(group / "memory.max")); });
    each_group(root, "memory",
               [&](const fs::path& group) { allow(number_of(group / "memory.limit_in_bytes")); });
    rlimit limit{};
    if (getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY)
        allow(uint64_t(limit.rlim_cur));
    return least;
}

}  // namespace petzval::io

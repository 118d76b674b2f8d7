// SPDX-License-Identifier: Apache-2.0
#include "apps/live/guard.h"

#include <fmt/format.h>

#include <algorithm>
#include <random>

namespace petzval::apps {

std::string path_behind_token(const std::string& path, const ServerGate& gate) {
    if (gate.token.empty()) return path;
    const std::string folder = "/" + gate.token;
    if (!path.starts_with(folder + "/")) return "";
    return path.substr(folder.size());
}

std::string refusal_of(const RequestHead& head, const ServerGate& gate) {
    // A name that another site gives this machine's address (DNS rebinding) is none of ours.
    if (gate.token.empty() && std::ranges::find(gate.hosts, head.host) == gate.hosts.end())
        return "This server answers under " + gate.hosts.front() + " alone.";
    if (path_behind_token(head.path, gate).empty())
        return "The address lacks its token; take the address that petzval live printed.";
    if (!head.origin.empty() && head.origin != "http://" + head.host)
        return "Requests of other pages are not answered.";
    // A link of another page may lead to this one.
    const bool is_link = head.method == "GET" && head.fetch_mode == "navigate" &&
                         path_behind_token(head.path, gate) == "/";
    if (!head.fetch_site.empty() && head.fetch_site != "same-origin" && head.fetch_site != "none" &&
        !is_link)
        return "Requests of other pages are not answered.";
    if (head.method == "POST" && !head.content_type.starts_with("application/json"))
        return "A request must be JSON.";
    if (head.encoded) return "A body must be sent as it is, with its length.";
    return "";
}

std::string random_token() {
    std::random_device random;  // of the system, fit for secrets on Linux
    std::string out;
    for (int i = 0; i < 4; ++i) out += fmt::format("{:08x}", random());
    return out;
}

}  // namespace petzval::apps

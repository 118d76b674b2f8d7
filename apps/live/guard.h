// SPDX-License-Identifier: Apache-2.0
// Which requests a live server answers: those of its own page. Other pages in the same browser can
// reach 127.0.0.1 too.
#pragma once

#include <string>
#include <vector>

namespace petzval::apps {

/// What a browser says of a request.
struct RequestHead {
    std::string method, path;  ///< path: without a query
    std::string host, origin;  ///< origin: empty where it is not said
    std::string fetch_site;    ///< Sec-Fetch-Site (W3C Fetch Metadata); empty: not said
    std::string fetch_mode;    ///< Sec-Fetch-Mode
    std::string content_type;
    bool encoded = false;  ///< a body that is compressed, or whose length is not said
};

/// Rules of a server.
struct ServerGate {
    /// Values of Host that are its own; with a token any, as no other page knows the token.
    std::vector<std::string> hosts;
    std::string token;  ///< first folder of each path; empty: none
};

/// The path behind the token, which begins with "/"; empty where the token is another one.
[[nodiscard]] std::string path_behind_token(const std::string& path, const ServerGate&);

/// Why a request is refused; empty where it is answered.
[[nodiscard]] std::string refusal_of(const RequestHead&, const ServerGate&);

/// Token of 128 random bits, as 32 digits.
[[nodiscard]] std::string random_token();

}  // namespace petzval::apps

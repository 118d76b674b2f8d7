// SPDX-License-Identifier: Apache-2.0
// Server of `petzval live`: the page, and a view finder for each page that is open.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "apps/request/render_order.h"

namespace petzval::apps {

struct LiveOptions {
    RenderOrder start;  ///< what a page begins with
    /// Address to listen on; absent: 127.0.0.1. With one, pages need a token, as others can reach
    /// it.
    std::optional<std::string> listen;
    int port = 0;        ///< 0: a free one
    bool learn = false;  ///< the page to learn from, in place of the view finder
    /// Command line of an order.
    std::function<std::string(const RenderOrder&)> command;
};

/// Answers the requests of its pages from when it is made until it goes. Rendering takes as many
/// threads as the order says. Throws InputError where it cannot listen there or the page's files
/// are missing, ValueError for a port or address.
class LiveServer {
  public:
    explicit LiveServer(LiveOptions);
    ~LiveServer();
    LiveServer(const LiveServer&) = delete;
    LiveServer& operator=(const LiveServer&) = delete;

    /// Address of the page: http://127.0.0.1:PORT/
    [[nodiscard]] const std::string& address() const { return address_; }

  private:
    class Site;
    std::string address_;
    std::unique_ptr<Site> site_;
};

}  // namespace petzval::apps

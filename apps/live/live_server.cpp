// SPDX-License-Identifier: Apache-2.0
#include "apps/live/live_server.h"

#include <fmt/format.h>
#include <httplib.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <charconv>
#include <chrono>
#include <map>
#include <mutex>
#include <thread>

#include "apps/live/facts.h"
#include "apps/live/guard.h"
#include "apps/live/lens_bench.h"
#include "apps/live/page_files.h"
#include "apps/live/saved_file.h"
#include "apps/request/option_text.h"
#include "apps/request/value_error.h"
#include "camera/lens/lens.h"
#include "io/base/error.h"
#include "io/file/atomic_file.h"
#include "io/lens/lens_drawing.h"
#include "io/lens/lens_file.h"

namespace petzval {
namespace {

using httplib::Request, httplib::Response;
using Json = nlohmann::json;

constexpr size_t kMostBody_bytes = 65536;
/// A stream that has nothing to tell looks this often whether its page is still there.
constexpr std::chrono::milliseconds kBreath{250};

constexpr int kBadRequest = 400, kForbidden = 403, kNotFound = 404, kConflict = 409,
              kUnavailable = 503;

// Nothing of other sites is loaded, and no other site shows the page in a frame.
constexpr const char* kPolicy =
    "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' blob:; "
    "connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

void answer(Response& response, const Json& json, int status = 200) {
    response.status = status;
    response.set_content(text_of(json), "application/json");
}

void refuse(Response& response, int status, const std::string& why, const std::string& field = "") {
    answer(response, {{"error", as_options(why)}, {"field", field}}, status);
}

void add_security_headers(Response& response) {
    for (const auto& [name, value] : {std::pair{"Content-Security-Policy", kPolicy},
                                      {"X-Content-Type-Options", "nosniff"},
                                      {"Referrer-Policy", "no-referrer"},
                                      {"Cache-Control", "no-store"},
                                      {"Cross-Origin-Resource-Policy", "same-origin"}})
        response.set_header(name, value);
}

// Number of a query's parameter; 0 where it is none.
uint64_t number_of(const Request& request, const char* name) {
    uint64_t out = 0;
    const std::string text = request.get_param_value(name);
    std::from_chars(text.data(), text.data() + text.size(), out);
    return out;
}

// As an address names a host: one that means all addresses of a machine is no name of it.
std::string name_in_address(const std::string& host) {
    if (host == "0.0.0.0" || host == "::") {
        std::array<char, 256> name{};
        return gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "localhost";
    }
    return host.find(':') == std::string::npos ? host : "[" + host + "]";
}

std::vector<float> channel_of(const PictureRows& light, const std::string& name) {
    const int channel = channel_index(light.layout, name);
    if (channel < 0) throw ValueError("channel", "is none of this picture");
    const size_t width = size_t(light.layout.width), count = light.layout.channels.size();
    std::vector<float> row(width * count), out;
    for (int y = 0; y < light.layout.height; ++y) {
        light.row(y, row.data());
        for (size_t x = 0; x < width; ++x) out.push_back(row[x * count + size_t(channel)]);
    }
    return out;
}

std::string event_of(const char* name, const Json& json) {
    return fmt::format("event: {}\ndata: {}\n\n", name, text_of(json));
}

}  // namespace

class LiveServer::Pages {
  public:
    explicit Pages(LiveOptions options)
        : options_(std::move(options)),
          rules_(rules_of(options_.start)),
          files_(read_page_files()),
          facts_(program_facts(rules_)) {
        if (options_.listen) gate_.token = random_token();
        // A browser keeps six connections, each of which keeps a thread.
        server_.new_task_queue = [] { return new httplib::ThreadPool(8 * kMostPages); };
        server_.set_keep_alive_timeout(2);
        server_.set_keep_alive_max_count(10'000);
        server_.set_payload_max_length(kMostBody_bytes);
        server_.set_tcp_nodelay(true);
        // Not SO_REUSEPORT, with which two servers share a port.
        server_.set_socket_options([](socket_t socket) {
            const int yes = 1;
            setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof(yes));
        });
        route();
    }

    ~Pages() {
        closing_ = true;
        server_.stop();
    }

    /// Listens; the address of the page.
    std::string start() {
        const std::string host = options_.listen.value_or("127.0.0.1");
        int port = options_.port;
        if (port == 0)
            port = server_.bind_to_any_port(host);
        else if (!server_.bind_to_port(host, port))
            port = -1;
        if (port < 0)
            throw ValueError(
                options_.port == 0 ? "--listen" : "--port",
                fmt::format("nobody can listen on {}{}: either the address is none of this "
                            "machine's, or another program listens there; --port 0 takes a free "
                            "port",
                            host,
                            options_.port == 0 ? "" : fmt::format(", port {}", options_.port)));
        for (const char* name : {"127.0.0.1", "localhost"})
            gate_.hosts.push_back(fmt::format("{}:{}", name, port));
        thread_ = std::jthread([this] { server_.listen_after_bind(); });
        while (!server_.is_running())  // before that stop() does nothing
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        return fmt::format("http://{}:{}/{}", name_in_address(host), port,
                           gate_.token.empty() ? "" : gate_.token + "/");
    }

  private:
    struct OpenPage {
        std::shared_ptr<Viewer> viewer;
        std::unique_ptr<OwnFolder> folder;  ///< of changed lenses; nullptr: none yet
        bool connected = false;
        uint64_t left = 0;  ///< the how many-th that left
    };
    using Handler = void (Pages::*)(const Request&, Response&);

    void route() {
        server_.set_pre_routing_handler([this](const Request& request, Response& response) {
            add_security_headers(response);
            const auto header = [&](const char* name) { return request.get_header_value(name); };
            const std::string why = refusal_of(
                {request.method, request.path, header("Host"), header("Origin"),
                 header("Sec-Fetch-Site"), header("Sec-Fetch-Mode"), header("Content-Type"),
                 request.has_header("Content-Encoding") || request.has_header("Transfer-Encoding")},
                gate_);
            if (why.empty()) return httplib::Server::HandlerResponse::Unhandled;
            refuse(response, kForbidden, why);
            return httplib::Server::HandlerResponse::Handled;
        });
        server_.set_exception_handler(
            [](const Request&, Response& response, const std::exception_ptr& error) {
                try {
                    std::rethrow_exception(error);
                } catch (const ValueError& fault) {
                    refuse(response, kBadRequest, fault.what(), fault.option());
                } catch (const std::exception& fault) {
                    refuse(response, kBadRequest, fault.what());
                }
            });
        const std::map<std::string, Handler> gets{
            {"/api/facts", &Pages::tell_facts},     {"/api/events", &Pages::stream_events},
            {"/api/picture", &Pages::send_picture}, {"/api/file", &Pages::send_file},
            {"/api/values", &Pages::send_values},   {"/api/pixel", &Pages::tell_pixel},
            {"/api/lens", &Pages::send_lens},       {"/api/lens.svg", &Pages::draw_lens}};
        server_.Get(".*", [this, gets](const Request& request, Response& response) {
            const std::string path = path_behind_token(request.path, gate_);
            if (const auto found = gets.find(path); found != gets.end())
                return (this->*found->second)(request, response);
            send_page(path == "/" ? "index.html" : path.substr(1), response);
        });
        const std::map<std::string, Handler> posts{{"/api/request", &Pages::take_request},
                                                   {"/api/bench", &Pages::measure_lens},
                                                   {"/api/lens", &Pages::take_lens}};
        server_.Post(".*", [this, posts](const Request& request, Response& response) {
            if (const auto found = posts.find(path_behind_token(request.path, gate_));
                found != posts.end())
                return (this->*found->second)(request, response);
            refuse(response, kNotFound, "there is nothing under this address");
        });
    }

    void send_page(const std::string& name, Response& response) {
        const auto file = files_.find(name);
        if (file == files_.end())
            return refuse(response, kNotFound, "there is nothing under this address");
        response.set_content(file->second.bytes, file->second.type);
    }

    void tell_facts(const Request&, Response& response) { answer(response, facts_); }

    std::shared_ptr<Viewer> viewer_of(const std::string& page) {
        const std::lock_guard lock(mutex_);
        const auto found = pages_.find(page);
        if (found == pages_.end()) throw ValueError("page", "is not connected; load it again");
        return found->second.viewer;
    }

    PageRules rules_for(const std::string& page) {
        PageRules rules = rules_;
        const std::lock_guard lock(mutex_);
        if (const auto found = pages_.find(page); found != pages_.end() && found->second.folder)
            rules.folders.push_back(found->second.folder->path());
        return rules;
    }

    // A page that comes back finds its picture, unless others took its place. Empty: none is free.
    std::string open_page(const std::string& wanted) {
        OpenPage gone;  // ends without the lock
        const std::lock_guard lock(mutex_);
        if (const auto found = pages_.find(wanted);
            found != pages_.end() && !found->second.connected) {
            found->second.connected = true;
            return wanted;
        }
        if (pages_.size() >= kMostPages) {
            const auto oldest = std::ranges::min_element(pages_, {}, [](const auto& page) {
                return page.second.connected ? UINT64_MAX : page.second.left;
            });
            if (oldest->second.connected) return "";
            gone = std::move(oldest->second);
            pages_.erase(oldest);
        }
        const std::string page = random_token();
        pages_[page] = {std::make_shared<Viewer>(threads_of(options_.start.run), scene_), nullptr,
                        true, 0};
        return page;
    }

    void close_page(const std::string& page) {
        const std::lock_guard lock(mutex_);
        OpenPage& closed = pages_.at(page);
        if (SharedScene scene = closed.viewer->scene(); scene.loaded.prepared.scene)
            scene_ = std::move(scene);  // for the page that comes next
        closed.viewer->leave();
        closed.connected = false;
        closed.left = ++leavings_;
    }

    void stream_events(const Request& request, Response& response) {
        const std::string page = open_page(request.get_param_value("page"));
        if (page.empty())
            return refuse(response, kUnavailable,
                          fmt::format("{} pages are open already; close or hide one", kMostPages));
        struct Told {
            uint64_t number = 0;
            const Scene* scene = nullptr;
            bool greeted = false;
        };
        const auto told = std::make_shared<Told>();
        response.set_chunked_content_provider(
            "text/event-stream",
            [this, page, told, viewer = viewer_of(page)](size_t, httplib::DataSink& sink) {
                std::string text;
                if (!told->greeted) {
                    told->greeted = true;
                    text = event_of("page", {{"page", page}});
                } else {
                    const LiveStatus now = viewer->wait(told->number, kBreath);
                    const LoadedScene scene = viewer->scene().loaded;
                    if (scene.prepared.scene.get() != told->scene) {
                        told->scene = scene.prepared.scene.get();
                        text += event_of("scene", scene_facts(scene));
                    }
                    if (now.number != told->number) {
                        told->number = now.number;
                        text += event_of("status", status_facts(now));
                    }
                }
                if (closing_ || !sink.is_writable()) return false;
                return text.empty() || sink.write(text.data(), text.size());
            },
            [this, page](bool) { close_page(page); });
    }

    void take_request(const Request& request, Response& response) {
        const Json asked = Json::parse(request.body, nullptr, false);
        if (!asked.is_object() || !asked.contains("page") || !asked["page"].is_string() ||
            !asked.contains("version") || !asked["version"].is_number_unsigned() ||
            !asked.contains("fields") || !asked["fields"].is_object())
            return refuse(response, kBadRequest,
                          "a request is {\"page\": ..., \"version\": 1, \"fields\": {...}}");
        const auto viewer = viewer_of(asked["page"]);
        viewer->leave();  // what is shown is of other settings, even if these are refused
        const RenderOrder order = order_of_page(asked["fields"], rules_for(asked["page"]));
        viewer->ask(asked["version"], order.render);
        answer(response, {{"command", options_.command(order)}});
    }

    void send_picture(const Request& request, Response& response) {
        const auto picture = viewer_of(request.get_param_value("page"))->picture();
        if (!picture) return refuse(response, kNotFound, "there is no picture yet");
        response.set_header("X-Size", fmt::format("{}x{}", picture->size_px.x, picture->size_px.y));
        response.set_content(reinterpret_cast<const char*>(picture->rgba.data()),
                             picture->rgba.size(), "application/octet-stream");
    }

    void send_file(const Request& request, Response& response) {
        const std::string name = request.get_param_value("name");
        const auto viewer = viewer_of(request.get_param_value("page"));
        const uint64_t version = number_of(request, "version");
        response.set_header("Content-Disposition", "attachment");
        response.set_content(
            saved_file(name,
                       [&](const std::filesystem::path& path) { viewer->write(version, path); }),
            "application/octet-stream");
    }

    // Values of a channel, 32-bit floats row by row.
    void send_values(const Request& request, Response& response) {
        const std::string name = request.get_param_value("channel");
        std::vector<float> values;
        viewer_of(request.get_param_value("page"))
            ->inspect(number_of(request, "version"), [&](const RenderSession& session) {
                values = channel_of(session.light(), name);
            });
        response.set_content(reinterpret_cast<const char*>(values.data()),
                             values.size() * sizeof(float), "application/octet-stream");
    }

    // All channels of a pixel.
    void tell_pixel(const Request& request, Response& response) {
        Json pixel = Json::object();
        const uint64_t x = number_of(request, "x"), y = number_of(request, "y");
        viewer_of(request.get_param_value("page"))
            ->inspect(number_of(request, "version"), [&](const RenderSession& session) {
                const PictureRows light = session.light();
                if (x >= uint64_t(light.layout.width) || y >= uint64_t(light.layout.height))
                    throw ValueError("x,y", "lies outside of the picture");
                const std::vector<std::string>& channels = light.layout.channels;
                std::vector<float> row(channels.size() * size_t(light.layout.width));
                light.row(static_cast<int>(y), row.data());
                for (size_t i = 0; i < channels.size(); ++i)
                    pixel[channels[i]] = number_or_null(double(row[x * channels.size() + i]));
            });
        answer(response, pixel);
    }

    // {"lens": name, "edited": text of a file, "height_mm", "focus_m", "fstop"}: all but the name
    // may lack.
    void measure_lens(const Request& request, Response& response) {
        const Json asked = Json::parse(request.body);
        answer(response, bench_facts({asked.at("lens"), asked.value("edited", ""),
                                      asked.value("height_mm", 0.), asked.value("focus_m", 0.),
                                      asked.value("fstop", 0.)}));
    }

    void send_lens(const Request& request, Response& response) {
        response.set_content(lens_text(request.get_param_value("name")), "application/json");
    }

    // Keeps a changed lens as a file as long as the page is there; a new one each time, so that no
    // picture is of another lens than its name says.
    void take_lens(const Request& request, Response& response) {
        const Json asked = Json::parse(request.body);
        const std::string page = asked.at("page"), text = asked.at("lens");
        (void)viewer_of(page);
        (void)parse_lens(text, "lens");
        const std::lock_guard lock(mutex_);
        auto& folder = pages_.at(page).folder;
        if (!folder) folder = std::make_unique<OwnFolder>();
        const auto file = folder->path() / fmt::format("lens-{}.json", ++lenses_);
        write_file_atomically(file, text);
        answer(response, {{"lens", file.string()}});
    }

    void draw_lens(const Request& request, Response& response) {
        const std::string name = request.get_param_value("name");
        for (const LensSummary& known : list_lenses())
            if (known.name == name) {
                const Lens lens(load_lens(name).lens);
                const LensDrawing drawing{.film_mm = lens.film_mm(),
                                          .film_radius_mm = lens.prescription().image_circle_mm / 2,
                                          .rays = {},
                                          .caption = ""};
                return response.set_content(lens_svg(lens, drawing), "image/svg+xml");
            }
        refuse(response, kNotFound, "no lens of that name ships");
    }

    LiveOptions options_;
    PageRules rules_;
    std::map<std::string, PageFile> files_;
    Json facts_;
    ServerGate gate_;
    std::atomic<bool> closing_ = false;
    std::mutex mutex_;  ///< of the four below
    std::map<std::string, OpenPage> pages_;
    uint64_t leavings_ = 0, lenses_ = 0;
    SharedScene scene_;
    httplib::Server server_;
    std::jthread thread_;  ///< last: it uses the others
};

LiveServer::LiveServer(LiveOptions options) : pages_(std::make_unique<Pages>(std::move(options))) {
    address_ = pages_->start();
}

LiveServer::~LiveServer() = default;

}  // namespace petzval

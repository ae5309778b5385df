// stream_object on the event interface of nlohmann's parser, which keeps its own stack: deep nesting cannot
// exhaust ours.
#include "json_stream.hpp"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <carom/core/scene.hpp>

namespace carom {
namespace {

/// What people do most often where a parser says this.
std::string_view likely_cause(std::string_view rule) {
    const auto says = [rule](std::string_view text) { return rule.find(text) != std::string_view::npos; };
    const bool wants_end = rule.ends_with("expected '}'") || rule.ends_with("expected ']'");
    if (wants_end && !says("end of input")) return " (is a comma missing before it?)";
    if (says("unexpected '}'; expected string") || says("parsing value - unexpected ']'"))
        return " (is there a comma too many before it?)";
    return "";
}

/// Builds the values that the handlers want out of the parser's events.
class Builder : public nlohmann::json_sax<Json> {
 public:
    Builder(std::string_view text, const JsonHandlers& handlers) : text_(text), handlers_(handlers) {}

    bool null() override { return add(nullptr); }
    bool boolean(bool value) override { return add(value); }
    bool number_integer(number_integer_t value) override { return add(value); }
    bool number_unsigned(number_unsigned_t value) override { return add(value); }
    bool number_float(number_float_t value, const string_t& /*text*/) override { return add(value); }
    bool string(string_t& value) override { return add(std::move(value)); }
    bool binary(binary_t& /*value*/) override { return false; }  // JSON text has none

    bool start_object(std::size_t /*size*/) override {
        if (in_root_) return open(Json::object());
        return in_root_ = true;
    }
    bool end_object() override { return open_.empty() || close(); }

    bool start_array(std::size_t /*size*/) override {
        if (in_root_ && open_.empty() && by_element_ && !index_) {
            index_ = 0;
            return true;
        }
        return open(Json::array());
    }
    bool end_array() override {
        if (!open_.empty()) return close();
        index_.reset();
        return true;
    }

    bool key(string_t& key) override {
        if (open_.empty()) {
            root_key_ = std::move(key);
            by_element_ = handlers_.key(root_key_);
            return true;
        }
        if (open_.back().value.contains(key)) fail_here(key, "is given twice");
        open_.back().key = std::move(key);
        return true;
    }

    bool parse_error(std::size_t position, const std::string& /*token*/,
                     const Json::exception& error) override {
        // Of "[name.id] parse error at line 1, column 2: syntax error ..." only the last part is for the
        // user.
        std::string_view rule = error.what();
        if (const auto start = rule.find("syntax error"); start != std::string_view::npos)
            rule.remove_prefix(start);
        else if (const auto bracket = rule.find("] "); bracket != std::string_view::npos)
            rule.remove_prefix(bracket + 2);
        if (const auto last_read = rule.find("; last read: "); last_read != std::string_view::npos) {
            const std::string_view read = rule.substr(last_read + 13);
            const bool is_slash =
                rule.find("invalid literal") < last_read && read.find("/'") != std::string_view::npos;
            throw SceneError(where(position),
                             fmt::format("{}{}{}", rule.substr(0, last_read + 13), quotable(read),
                                         is_slash ? " (JSON has no comments)" : ""));
        }
        throw SceneError(where(position), fmt::format("{}{}", rule, likely_cause(rule)));
    }

 private:
    struct Open {
        Json value;
        std::string key;  ///< of the member at hand, in an object
    };

    // The deepest value of a scene stands four deep: fill[0].region.min[0].
    static constexpr std::size_t kDeepest = 8;

    bool open(Json&& value) {
        if (!in_root_) fail_not_object(value);
        if (open_.size() == kDeepest) fail_here({}, "is nested too deeply");
        open_.push_back({std::move(value), {}});
        return true;
    }

    bool close() {
        Json value = std::move(open_.back().value);
        open_.pop_back();
        return add(std::move(value));
    }

    bool add(Json&& value) {
        if (!in_root_) fail_not_object(value);
        if (open_.empty()) {
            handlers_.value(value, {nullptr, root_key_, index_});
            if (index_) ++*index_;
        } else if (Open& parent = open_.back(); parent.value.is_array()) {
            parent.value.push_back(std::move(value));
        } else {
            parent.value[parent.key] = std::move(value);
        }
        return true;
    }

    [[noreturn]] static void fail_not_object(const Json& value) {
        throw SceneError({}, fmt::format("a scene must be a JSON object, is {}", kind_of(value)));
    }

    /// Throws for the place at hand, or for a member of it.
    [[noreturn]] void fail_here(std::string_view member, const std::string& rule) const {
        std::string place = Place{nullptr, root_key_, index_}.text();
        for (std::size_t i = 0; i < open_.size(); ++i) {
            const Open& level = open_[i];
            const bool last = i + 1 == open_.size();
            if (level.value.is_array())
                place += fmt::format("[{}]", level.value.size());
            else if (const std::string_view key = last && !member.empty() ? member : level.key; !key.empty())
                place += fmt::format(".{}", quotable(key));
        }
        throw SceneError(place, rule);
    }

    [[nodiscard]] std::string where(std::size_t position) const {
        const std::string_view before = text_.substr(0, std::min(position, text_.size()));
        const auto line = std::count(before.begin(), before.end(), '\n') + 1;
        const auto line_start = before.rfind('\n');
        const std::size_t column =
            line_start == std::string_view::npos ? before.size() : before.size() - line_start - 1;
        return fmt::format("line {}, column {}", line, std::max<std::size_t>(column, 1));
    }

    std::string_view text_;
    const JsonHandlers& handlers_;
    bool in_root_ = false;
    std::string root_key_;
    bool by_element_ = false;           ///< an array under root_key_ is taken element by element
    std::optional<std::size_t> index_;  ///< of the element, inside such an array
    std::vector<Open> open_;            ///< the values that are being built, outermost first
};

}  // namespace

void stream_object(std::string_view text, const JsonHandlers& handlers) {
    if (text.find_first_not_of(" \t\r\n") == std::string_view::npos)
        throw SceneError({}, "the scene is empty");
    Builder builder(text, handlers);
    (void)Json::sax_parse(text.begin(), text.end(), &builder);
}

}  // namespace carom

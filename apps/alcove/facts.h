/// The output of the info verb: the same facts as JSON and as aligned lines.
#pragma once

#include "alcove/mesh/mesh.h"

#include <nlohmann/json.hpp>

#include <string>
#include <vector>

namespace alcove::cli {

class Facts {
  public:
    /// Adds a fact to the JSON only. The fact `kind` is also the heading of the text.
    void add(const std::string& key, nlohmann::ordered_json value) { json_[key] = std::move(value); }
    /// Adds a fact with its lines of text. The label is the key, with spaces instead of underscores. If there are no
    /// lines, the text omits the fact.
    void add(const std::string& key, nlohmann::ordered_json value, const std::vector<std::string>& lines);
    void add(const std::string& key, nlohmann::ordered_json value, const std::string& line) {
        add(key, std::move(value), std::vector{line});
    }
    void add_count(const std::string& key, std::size_t count);
    /// Adds the facts `box` and `size`.
    void add_box(const Box& box);

    nlohmann::ordered_json json(const std::string& file) const;
    std::string text(const std::string& file) const;

  private:
    nlohmann::ordered_json json_;
    std::string text_;
};

Facts facts_of_mesh(const Mesh& mesh);

}

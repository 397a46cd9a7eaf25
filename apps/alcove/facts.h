/// What the info verb has to say: the same facts as JSON and as aligned lines.
#pragma once

#include "alcove/mesh/mesh.h"

#include <nlohmann/json.hpp>

#include <string>
#include <vector>

namespace alcove::cli {

class Facts {
  public:
    /// A fact for programs only; the one named `kind` heads the lines.
    void add(const std::string& key, nlohmann::ordered_json value) { json_[key] = std::move(value); }
    /// One that people read as `lines`, under the key with its underscores as spaces; no lines, no fact.
    void add(const std::string& key, nlohmann::ordered_json value, const std::vector<std::string>& lines);
    void add(const std::string& key, nlohmann::ordered_json value, const std::string& line) {
        add(key, std::move(value), std::vector{line});
    }
    void add_count(const std::string& key, std::size_t count);
    /// Box and size.
    void add_box(const Box& box);

    nlohmann::ordered_json json(const std::string& file) const;
    std::string text(const std::string& file) const;

  private:
    nlohmann::ordered_json json_;
    std::string text_;
};

Facts facts_of_mesh(const Mesh& mesh);

}

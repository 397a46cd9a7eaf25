/// What a file held beyond the Mesh itself, kept so that writing the same format again gives it back.
#pragma once

namespace alcove {

/// Base of PlyDocument and ObjDocument. Belongs to the vertices and faces it was read with: code that moves,
/// reorders or removes them resets `Mesh::source`.
class SourceDocument {
  public:
    virtual ~SourceDocument() = default;

  protected:
    SourceDocument() = default;
    SourceDocument(const SourceDocument&) = default;
    SourceDocument& operator=(const SourceDocument&) = default;
};

}

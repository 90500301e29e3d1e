// SPDX-License-Identifier: BSD-3-Clause
// Layout: header (16 bytes: 'O' 'M', kind of mesh, version, numbers of vertices, faces, edges), then chunks, each with a head of 16 bits that says what it
// holds of which entity in which scalar type. See OpenMesh/Core/IO/OMFormat.hh, whose names are used here. All little-endian.
#include "host/io/om_chunks.h"

#include <cstdint>
#include <cstring>
#include <limits>

namespace lcl {
namespace {

enum Type { type_position = 0, type_normal = 1, type_texcoord = 2, type_status = 3, type_colour = 4, type_custom = 6, type_topology = 7 };
enum Entity { entity_vertex = 0, entity_mesh = 1, entity_face = 2, entity_edge = 4, entity_halfedge = 6, entity_sentinel = 7 };

struct ChunkHead {
    explicit ChunkHead(unsigned bits)
        : has_name((bits >> 1) & 1),
          entity((bits >> 2) & 7),
          type((bits >> 5) & 15),
          is_floating((bits >> 10) & 1),
          dimension(((bits >> 11) & 7) + 1),
          size_code((bits >> 14) & 3) {}
    bool has_name;
    unsigned entity, type;
    bool is_floating;
    unsigned dimension, size_code;

    std::size_t integer_size() const { return std::size_t(1) << size_code; }
    std::size_t vector_size() const { return dimension * ((is_floating ? 4u : 1u) << size_code); }
};

struct Span {
    const char* first = nullptr;
    const char* last = nullptr;
    std::size_t size() const { return static_cast<std::size_t>(last - first); }
};

/// A chunk that OpenMesh is to see.
struct Chunk {
    Span data;
    unsigned size_code = 0;
    std::size_t integer_size() const { return std::size_t(1) << size_code; }
    explicit operator bool() const { return data.first != nullptr; }
};

/// The head that OpenMesh writes for such a chunk. It asserts that parts of a head are as it would write them, which those of a file need not be.
std::uint16_t head_bits(Entity entity, Type type, unsigned size_code, unsigned dimension, bool is_floating) {
    return static_cast<std::uint16_t>(entity << 2 | type << 5 | (is_floating ? 0x600u : 0u) | (dimension - 1) << 11 | size_code << 14);
}

class OmChecker {
public:
    explicit OmChecker(const InputBytes& input) : input_(input), at_(input.data) {}

    OmContent check() {
        read_header();
        while (remaining() >= 2)
            if (!read_chunk()) break;
        if (vertices_ > 0 && !positions_) fail("there are no vertex positions");
        if (faces_ > 0 && !face_topology_) fail("there are no faces, though the header counts " + std::to_string(faces_));
        if (is_version_2_) check_half_edges();
        else check_face_vertices();
        content_.vertex_count = static_cast<Index>(vertices_);
        content_.face_count = static_cast<Index>(faces_);
        content_.has_colours = static_cast<bool>(colours_);
        assemble();
        return std::move(content_);
    }

private:
    std::size_t remaining() const { return static_cast<std::size_t>(input_.data + input_.size - at_); }

    [[noreturn]] void fail(const std::string& sentence) const {
        throw BadInput(input_.name + ": " + sentence + " (byte " + std::to_string(at_ - input_.data) + "); the file is damaged or no OM file");
    }

    Span take(std::uint64_t size, const char* what) {
        if (size > remaining())
            fail(std::string(what) + " would take " + std::to_string(size) + " bytes, the file has " + std::to_string(remaining()) + " left");
        const char* first = at_;
        at_ += size;
        return {first, at_};
    }

    template <class T>
    T take_number(const char* what) {
        T value;
        std::memcpy(&value, take(sizeof(T), what).first, sizeof(T));
        return value;
    }

    void read_header() {
        const Span head = take(4, "the header");
        if (head.first[0] != 'O' || head.first[1] != 'M') fail("an OM file begins with 'OM'");
        kind_ = head.first[2];
        if (kind_ != 'T' && kind_ != 'Q' && kind_ != 'P') fail("the kind of mesh is none of T, Q, P");
        const unsigned version = static_cast<unsigned char>(head.first[3]);
        is_version_2_ = version >= (2u << 5);
        custom_has_type_ = version > ((2u << 5) | 1u);
        vertices_ = take_number<std::uint32_t>("the header");
        faces_ = take_number<std::uint32_t>("the header");
        edges_ = take_number<std::uint32_t>("the header");
        for (const std::uint64_t count : {vertices_, faces_, 2 * edges_})
            if (count > static_cast<std::uint64_t>(std::numeric_limits<Index>::max()) || count > 8 * input_.size)
                fail("the header counts more than the file can hold");
    }

    /// False at the end mark.
    bool read_chunk() {
        const ChunkHead head(take_number<std::uint16_t>("a chunk's head"));
        if (head.entity == entity_sentinel) return false;
        if (head.has_name) take(take_number<std::uint8_t>("a name"), "a name");
        if (head.type == type_custom) return skip_custom();
        const Span data = take(entity_count(head) * element_size(head), "a chunk");
        if (head.entity == entity_face && head.type == type_topology && !is_version_2_) skip_face_vertices(head);
        keep({{data.first, at_}, head.size_code}, head);
        return true;
    }

    bool skip_custom() {
        if (custom_has_type_) take(take_number<std::uint8_t>("the type of a property"), "the type of a property");
        take(take_number<std::uint32_t>("a property"), "a property");
        note_dropped("custom properties");
        return true;
    }

    std::uint64_t entity_count(const ChunkHead& head) const {
        switch (head.entity) {
            case entity_vertex: return vertices_;
            case entity_face: return faces_;
            case entity_edge: return edges_;
            case entity_halfedge: return 2 * edges_;
            case entity_mesh: return 1;
            default: fail("a chunk belongs to no known kind of entity");
        }
    }

    std::size_t element_size(const ChunkHead& head) const {
        if (head.type == type_status) return 4;
        if (head.type != type_topology) return head.vector_size();
        if (head.integer_size() > 4) fail("indices of 64 bits are not read");
        if (head.entity == entity_halfedge) return 3 * head.integer_size();  // next half-edge, vertex it points at, face
        return head.entity == entity_face && !is_version_2_ ? 0 : head.integer_size();
    }

    /// Version 1 lists the vertices of each face, with their number (16 bits) if the mesh is polygonal.
    void skip_face_vertices(const ChunkHead& head) {
        for (std::uint64_t f = 0; f < faces_; ++f) {
            const std::size_t degree = kind_ == 'T' ? 3 : kind_ == 'Q' ? 4 : take_number<std::uint16_t>("a face");
            take(degree * head.integer_size(), "a face");
        }
    }

    void keep(const Chunk& chunk, const ChunkHead& head) {
        Chunk* place = head.entity == entity_vertex     ? vertex_place(head)
                       : head.entity == entity_face     ? (head.type == type_topology ? &face_topology_
                                                           : head.type == type_status ? &face_status_
                                                                                      : nullptr)
                       : head.entity == entity_halfedge ? (head.type == type_topology ? &half_edges_ : nullptr)
                                                        : nullptr;
        if (!place || head.has_name) {
            if (head.type == type_texcoord) note_dropped("texture coordinates");
            if (head.type == type_colour) note_dropped("colours of faces or edges");
            return;
        }
        if (*place) fail("a chunk comes twice");
        *place = chunk;
    }

    Chunk* vertex_place(const ChunkHead& head) {
        if (head.type == type_position && (head.dimension != 3 || !head.is_floating || head.size_code > 1)) fail("positions are not three floats or doubles");
        if (head.type == type_colour && (head.dimension != 3 || head.is_floating || head.size_code != 0)) {
            note_dropped("vertex colours of an unknown type");
            return nullptr;
        }
        switch (head.type) {
            case type_position: return &positions_;
            case type_colour: return &colours_;
            case type_status: return &vertex_status_;
            case type_topology: return &vertex_topology_;
            default: return nullptr;
        }
    }

    void note_dropped(const char* what) {
        for (const std::string& dropped : content_.dropped)
            if (dropped == what) return;
        content_.dropped.push_back(what);
    }

    /// Signed, as half-edges and faces that do not exist are -1.
    static std::int64_t number_at(const Chunk& chunk, std::uint64_t i) {
        const char* place = chunk.data.first + i * chunk.integer_size();
        if (chunk.integer_size() == 1) return static_cast<signed char>(*place);
        std::int16_t small;
        std::memcpy(&small, place, sizeof(small));
        if (chunk.integer_size() == 2) return small;
        std::int32_t value;
        std::memcpy(&value, place, sizeof(value));
        return value;
    }

    void check_half_edges() const {
        const std::int64_t half_edge_count = static_cast<std::int64_t>(2 * edges_);
        if (edges_ > 0 && !half_edges_) fail("there are no half-edges, though the header counts edges");
        for (std::int64_t h = 0; h < half_edge_count; ++h)
            if (!is_below(next_of(h), half_edge_count) ||
                !is_below(number_at(half_edges_, 3 * static_cast<std::uint64_t>(h) + 1), static_cast<std::int64_t>(vertices_)) ||
                !is_below(face_of(h) + 1, static_cast<std::int64_t>(faces_) + 1))
                fail("half-edge " + std::to_string(h) + " has a false successor, vertex or face");
        for (std::uint64_t v = 0; vertex_topology_ && v < vertices_; ++v)
            if (!is_below(number_at(vertex_topology_, v) + 1, half_edge_count + 1)) fail("vertex " + std::to_string(v) + " has a false half-edge");
        for (std::uint64_t f = 0; f < faces_; ++f) check_face(f, half_edge_count);
    }

    static bool is_below(std::int64_t value, std::int64_t end) { return value >= 0 && value < end; }
    std::int64_t next_of(std::int64_t half_edge) const { return number_at(half_edges_, 3 * static_cast<std::uint64_t>(half_edge)); }
    std::int64_t face_of(std::int64_t half_edge) const { return number_at(half_edges_, 3 * static_cast<std::uint64_t>(half_edge) + 2); }

    /// The walk round a face has to come back. As all half-edges on it must be the face's own, the walks of all faces together are no longer than the list.
    void check_face(std::uint64_t face, std::int64_t half_edge_count) const {
        const std::int64_t first = number_at(face_topology_, face);
        if (!is_below(first, half_edge_count)) fail("face " + std::to_string(face) + " has a false half-edge");
        if (is_deleted(face)) return;
        std::int64_t h = first, steps = 0;
        do {
            if (face_of(h) != static_cast<std::int64_t>(face) || ++steps > half_edge_count)
                fail("the half-edges round face " + std::to_string(face) + " do not make a loop of its own");
            h = next_of(h);
        } while (h != first);
    }

    bool is_deleted(std::uint64_t face) const {
        std::uint32_t status = 0;
        if (face_status_) std::memcpy(&status, face_status_.data.first + 4 * face, sizeof(status));
        return (status & 1u) != 0;  // OpenMesh::Attributes::DELETED
    }

    void check_face_vertices() const {
        const char* place = face_topology_.data.first;
        for (std::uint64_t f = 0; f < faces_; ++f) {
            std::size_t degree = kind_ == 'T' ? 3 : 4;
            if (kind_ == 'P') {
                std::uint16_t told;
                std::memcpy(&told, place, sizeof(told));
                place += sizeof(told);
                degree = told;
            }
            for (std::size_t c = 0; c < degree; ++c, place += face_topology_.integer_size()) {
                std::uint32_t vertex = 0;
                std::memcpy(&vertex, place, face_topology_.integer_size());
                if (vertex >= vertices_)
                    fail("face " + std::to_string(f) + " uses vertex " + std::to_string(vertex) + ", the file has " + std::to_string(vertices_));
            }
        }
    }

    void assemble() {
        content_.bytes.assign(input_.data, 16);
        append(positions_, head_bits(entity_vertex, type_position, positions_.size_code, 3, true));
        append(half_edges_, head_bits(entity_halfedge, type_topology, half_edges_.size_code, 3, true));
        append(vertex_topology_, head_bits(entity_vertex, type_topology, vertex_topology_.size_code, 1, true));
        append(face_topology_, head_bits(entity_face, type_topology, face_topology_.size_code, 1, true));
        append(colours_, head_bits(entity_vertex, type_colour, 0, 3, false));
        append(vertex_status_, head_bits(entity_vertex, type_status, 0, 1, false));
        append(face_status_, head_bits(entity_face, type_status, 0, 1, false));
        append_bits(entity_sentinel << 2);
    }

    void append(const Chunk& chunk, std::uint16_t bits) {
        if (!chunk) return;
        append_bits(bits);
        content_.bytes.append(chunk.data.first, chunk.data.size());
    }

    void append_bits(std::uint16_t bits) { content_.bytes.append(reinterpret_cast<const char*>(&bits), sizeof(bits)); }

    const InputBytes& input_;
    const char* at_;
    OmContent content_;
    char kind_ = 0;
    bool is_version_2_ = false, custom_has_type_ = false;
    std::uint64_t vertices_ = 0, faces_ = 0, edges_ = 0;
    Chunk positions_, colours_, vertex_status_, vertex_topology_, half_edges_, face_topology_, face_status_;
};

}  // namespace

OmContent check_om(const InputBytes& input) { return OmChecker(input).check(); }

}  // namespace lcl

// SPDX-License-Identifier: BSD-3-Clause
// gzip in memory and as a sink, by zlib.
#pragma once

#include <memory>
#include <string>

#include "host/io/format.h"
#include "host/io/input_file.h"

namespace lcl {

/// True if the bytes begin as a gzip file does.
bool is_gzip(const char* bytes, std::size_t size);

/// Unpacks a gzip file of one or more members. BadInput if it is damaged or cut off.
OwnedBytes unpack_gzip(const char* bytes, std::size_t size, const std::string& name);

/// Packs what it is given and passes it on; finish() writes the end.
class GzipSink : public ByteSink {
public:
    explicit GzipSink(ByteSink& target);
    ~GzipSink() override;
    GzipSink(const GzipSink&) = delete;
    GzipSink& operator=(const GzipSink&) = delete;
    void write(const char* bytes, std::size_t size) override;
    void finish();

private:
    void pack(int flush);

    struct State;
    std::unique_ptr<State> state_;
    ByteSink& target_;
};

}  // namespace lcl

// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <atomic>
#include <catch2/catch.hpp>
#include <cctype>
#include <numeric>
#include <thread>

#include "tests/device_support.h"
#include "tests/io_support.h"

using device_test::contains;
using device_test::Environment;
using io_test::error_of;
using lcl::Buffer;
using lcl::choose_device;
using lcl::Context;
using lcl::DeviceInfo;
using lcl::Event;
using lcl::list_devices;

namespace {

/// The list, which the tests need something in.
std::vector<DeviceInfo> devices_here() {
    std::vector<DeviceInfo> devices = list_devices();
    REQUIRE_FALSE(devices.empty());
    return devices;
}

std::string upper(std::string text) {
    for (char& c : text) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    return text;
}

std::vector<cl_int> numbers(std::size_t count, cl_int first = 0) {
    std::vector<cl_int> values(count);
    std::iota(values.begin(), values.end(), first);
    return values;
}

std::vector<cl_int> download(Context& context, const Buffer& buffer) {
    std::vector<cl_int> values(buffer.bytes() / sizeof(cl_int));
    context.read(buffer, 0, buffer.bytes(), values.data(), "reading back");
    return values;
}

cl_int status_of(const Event& event) {
    cl_int status = CL_COMPLETE;
    REQUIRE(clGetEventInfo(event.get(), CL_EVENT_COMMAND_EXECUTION_STATUS, sizeof status, &status, nullptr) == CL_SUCCESS);
    return status;
}

/// An event that the test completes: what waits for it cannot start before. Completed at the latest with the test, or the queues would wait for ever.
class Gate {
public:
    explicit Gate(const Context& context) {
        cl_int code = CL_SUCCESS;
        event_ = Event(clCreateUserEvent(context.get(), &code));
        REQUIRE(code == CL_SUCCESS);
    }
    ~Gate() { open(); }
    void open() {
        if (!opened_) clSetUserEventStatus(event_.get(), CL_COMPLETE);
        opened_ = true;
    }
    const Event& event() const { return event_; }

private:
    Event event_;
    bool opened_ = false;
};

/// OpenCL objects as a caller of the library has them.
struct Caller {
    explicit Caller(const DeviceInfo& device, cl_command_queue_properties properties = 0) {
        cl_int code = CL_SUCCESS;
        context = clCreateContext(nullptr, 1, &device.id, nullptr, nullptr, &code);
        REQUIRE(code == CL_SUCCESS);
        queue = clCreateCommandQueue(context, device.id, properties, &code);  // null where the device lacks the property
        memory = clCreateBuffer(context, CL_MEM_READ_WRITE, 1024, nullptr, &code);
        REQUIRE(code == CL_SUCCESS);
    }
    ~Caller() {
        clReleaseMemObject(memory);
        if (queue) clReleaseCommandQueue(queue);
        clReleaseContext(context);
    }
    cl_uint context_references() const {
        cl_uint count = 0;
        REQUIRE(clGetContextInfo(context, CL_CONTEXT_REFERENCE_COUNT, sizeof count, &count, nullptr) == CL_SUCCESS);
        return count;
    }
    cl_context context = nullptr;
    cl_command_queue queue = nullptr;
    cl_mem memory = nullptr;
};

/// Imports `rounds` times with other values each and says whether every row came out right: value + 1 for each of 1000 rows.
bool imports_rightly(Context& context, int rounds) {
    const auto shared = context.shared_from_this();
    const std::size_t count = 1000;
    const std::vector<float> frame{-1, 1, 1};
    const Buffer order = device_test::upload(shared, numbers(count), "order"), constants = device_test::upload(shared, frame, "frame");
    const Buffer rows(shared, count * sizeof(float), "rows"), source(shared, count * sizeof(float), "source");
    const cl_kernel kernel = context.kernel("transfer", "lcl_import_points", "-D LCL_WIDTH=1");
    std::vector<float> values(count), result(count);
    for (int round = 0; round < rounds; ++round) {
        std::iota(values.begin(), values.end(), static_cast<float>(round));
        context.write(source, 0, source.bytes(), values.data(), "writing");
        device_test::transfer(context, kernel, count, {}, order, constants, source, rows);
        context.read(rows, 0, rows.bytes(), result.data(), "reading");
        for (std::size_t i = 0; i < count; ++i) {
            if (result[i] != values[i] + 1) return false;
        }
    }
    return true;
}

}  // namespace

TEST_CASE("every listed device has its index, a name and memory", "[device][list]") {
    const std::vector<DeviceInfo> devices = devices_here();
    for (std::size_t i = 0; i < devices.size(); ++i) {
        CHECK(devices[i].index == static_cast<int>(i));
        CHECK_FALSE(devices[i].name.empty());
        CHECK_FALSE(devices[i].platform.empty());
        CHECK_FALSE(devices[i].driver.empty());
        CHECK(contains(devices[i].version, "OpenCL "));
        CHECK(devices[i].memory_bytes >= devices[i].max_allocation_bytes);
        CHECK(devices[i].max_allocation_bytes > 0);
        CHECK(devices[i].max_work_group_size > 0);
        CHECK(devices[i].compute_units > 0);
    }
}

TEST_CASE("a device is chosen by index", "[device][choose]") {
    for (const DeviceInfo& device : devices_here()) CHECK(choose_device(std::to_string(device.index)).id == device.id);
}

TEST_CASE("a device is chosen by part of its name or platform in any case, the first that matches", "[device][choose]") {
    const std::vector<DeviceInfo> devices = devices_here();
    for (const DeviceInfo& device : devices) {
        const auto first_with = [&](const std::string DeviceInfo::*text) {
            return std::find_if(devices.begin(), devices.end(), [&](const DeviceInfo& other) {
                return contains(upper(other.name), upper(device.*text)) || contains(upper(other.platform), upper(device.*text));
            });
        };
        CHECK(choose_device(upper(device.name)).id == first_with(&DeviceInfo::name)->id);
        CHECK(choose_device(device.platform).id == first_with(&DeviceInfo::platform)->id);
    }
    const DeviceInfo& first = devices.front();
    CHECK(choose_device(upper(first.name.substr(1))).id == first.id);
}

TEST_CASE("cpu and gpu choose by type, in any case", "[device][choose]") {
    const std::vector<DeviceInfo> devices = devices_here();
    const auto cpu = std::find_if(devices.begin(), devices.end(), [](const DeviceInfo& device) { return device.is_cpu; });
    if (cpu != devices.end()) {
        CHECK(choose_device("cpu").id == cpu->id);
        CHECK(choose_device("CPU").id == cpu->id);
    } else {
        CHECK_THROWS_AS(choose_device("cpu"), lcl::NoDevice);
    }
    const auto speed = [](const DeviceInfo& device) { return device.is_gpu ? double(device.compute_units) * std::max(1u, device.clock_mhz) : -1.0; };
    const auto gpu = std::max_element(devices.begin(), devices.end(), [&](const DeviceInfo& a, const DeviceInfo& b) { return speed(a) < speed(b); });
    if (gpu->is_gpu) {
        CHECK(choose_device("gpu").id == gpu->id);
        const Environment none("LIMITCL_DEVICE", nullptr);
        CHECK(choose_device().id == gpu->id);
    } else {
        CHECK_THROWS_AS(choose_device("gpu"), lcl::NoDevice);
    }
}

TEST_CASE("without a wish LIMITCL_DEVICE decides, else the device is a GPU if there is one", "[device][choose]") {
    const std::vector<DeviceInfo> devices = devices_here();
    for (const DeviceInfo& device : devices) {
        const Environment wish("LIMITCL_DEVICE", std::to_string(device.index).c_str());
        CHECK(choose_device().id == device.id);
        CHECK(choose_device("0").id == devices[0].id);  // what is asked for goes first
    }
    for (const char* value : {"", static_cast<const char*>(nullptr)}) {
        const Environment no_wish("LIMITCL_DEVICE", value);
        CHECK(choose_device().is_gpu == std::any_of(devices.begin(), devices.end(), [](const DeviceInfo& device) { return device.is_gpu; }));
    }
}

TEST_CASE("a device that is not there: what was asked for, what there is, and both ways to install one", "[device][choose]") {
    const std::vector<DeviceInfo> devices = devices_here();
    for (const std::string spec : {"no such device", "12345", "99999999999999999999999999", "-1"}) {
        const std::string sentence = error_of<lcl::NoDevice>([&] { choose_device(spec); });
        INFO(sentence);
        CHECK(contains(sentence, "'" + spec + "'"));
        CHECK_FALSE(contains(sentence, "LIMITCL_DEVICE"));
        for (const DeviceInfo& device : devices) CHECK(contains(sentence, std::to_string(device.index) + " = " + device.name));
        CHECK(contains(sentence, "apt install pocl-opencl-icd"));
        CHECK(contains(sentence, "GPU driver"));
    }
    const Environment wish("LIMITCL_DEVICE", "nothing like it");
    CHECK(contains(error_of<lcl::NoDevice>([] { choose_device(); }), "'nothing like it' (LIMITCL_DEVICE)"));
}

TEST_CASE("errors carry OpenCL's own name, the code, the call and what was being done", "[device][error]") {
    CHECK_NOTHROW(lcl::check(CL_SUCCESS, "clFinish", "nothing"));
    try {
        lcl::check(CL_OUT_OF_RESOURCES, "clFinish", "waiting for the end");
        FAIL("no error");
    } catch (const lcl::DeviceError& error) {
        CHECK(error.code == -5);
        CHECK(std::string(error.what()) == "clFinish failed with CL_OUT_OF_RESOURCES (-5) while waiting for the end");
    }
    for (const int code : {CL_MEM_OBJECT_ALLOCATION_FAILURE, CL_OUT_OF_HOST_MEMORY, CL_INVALID_BUFFER_SIZE})
        CHECK_THROWS_AS(lcl::check(code, "f", "x"), lcl::OutOfMemory);
    CHECK(std::string(lcl::opencl_error_name(CL_BUILD_PROGRAM_FAILURE)) == "CL_BUILD_PROGRAM_FAILURE");
    CHECK(std::string(lcl::opencl_error_name(-1001)) == "CL_PLATFORM_NOT_FOUND_KHR");
    CHECK(contains(lcl::opencl_error_name(-9999), "OpenCL"));
    for (int code = CL_INVALID_DEVICE_PARTITION_COUNT; code < 0; ++code) {
        if (code <= CL_INVALID_VALUE || code >= CL_KERNEL_ARG_INFO_NOT_AVAILABLE) CHECK(contains(lcl::opencl_error_name(code), "CL_"));
    }
}

TEST_CASE("a buffer above the largest allocation is refused with the numbers", "[device][buffer]") {
    const auto context = Context::create(choose_device());
    const std::size_t limit = context->device().max_allocation_bytes;
    const std::string sentence = error_of<lcl::OutOfMemory>([&] { Buffer(context, limit + 1, "the field of 9 channels"); });
    INFO(sentence);
    CHECK(contains(sentence, "the field of 9 channels needs " + std::to_string(limit + 1) + " bytes"));
    CHECK(contains(sentence, "the largest allocation of " + context->device().name + " is " + std::to_string(limit) + " bytes"));
    CHECK(context->allocated_bytes() == 0);
}

TEST_CASE("buffers that together exceed the device's memory are refused with the numbers", "[device][buffer]") {
    DeviceInfo small = choose_device();
    small.memory_bytes = 10000;
    small.max_allocation_bytes = 8000;
    const auto context = Context::create(small);
    const Buffer first(context, 6000, "the first");
    const std::string sentence = error_of<lcl::OutOfMemory>([&] { Buffer(context, 4001, "the second"); });
    INFO(sentence);
    CHECK(contains(sentence, "the second needs 4001 bytes, the memory of " + small.name + " is 10000 bytes, of which 6000 are in use"));
    CHECK_NOTHROW(Buffer(context, 4000, "what is left"));
}

TEST_CASE("allocated bytes follow the buffers as they are made, moved and released", "[device][buffer]") {
    const auto context = Context::create(choose_device());
    {
        Buffer first(context, 100, "first");
        Buffer second(context, 50, "second");
        CHECK(context->allocated_bytes() == 150);
        Buffer moved(std::move(first));
        CHECK_FALSE(first);
        CHECK(moved.bytes() == 100);
        CHECK(context->allocated_bytes() == 150);
        second = std::move(moved);
        CHECK(second.bytes() == 100);
        CHECK(context->allocated_bytes() == 100);
        second = Buffer();
        CHECK(context->allocated_bytes() == 0);
    }
    CHECK(context->allocated_bytes() == 0);
}

TEST_CASE("a buffer keeps its context alive", "[device][buffer]") {
    auto context = Context::create(choose_device());
    const std::weak_ptr<Context> watched = context;
    Buffer buffer(context, 64, "numbers");
    context.reset();
    REQUIRE_FALSE(watched.expired());
    const std::vector<cl_int> values = numbers(16);
    watched.lock()->write(buffer, 0, 64, values.data(), "writing");
    CHECK(download(*watched.lock(), buffer) == values);
    buffer = Buffer();
    CHECK(watched.expired());
}

TEST_CASE("copies touch the bytes asked for and no others", "[device][buffer]") {
    const auto context = Context::create(choose_device());
    const Buffer a = device_test::upload(context, numbers(10), "a"), b = device_test::upload(context, numbers(10, 100), "b");
    context->copy(a, 8, b, 20, 12, "copying");
    CHECK(download(*context, b) == std::vector<cl_int>{100, 101, 102, 103, 104, 2, 3, 4, 108, 109});
    const cl_int two[] = {-1, -2};
    context->write(b, 4, 8, two, "writing");
    CHECK(download(*context, b) == std::vector<cl_int>{100, -1, -2, 103, 104, 2, 3, 4, 108, 109});
    cl_int read[2] = {0, 0};
    context->read(b, 36, 4, read, "reading");
    CHECK(read[0] == 109);
    CHECK(read[1] == 0);
    context->fill_zero(b, "clearing");
    CHECK(download(*context, b) == std::vector<cl_int>(10, 0));
}

TEST_CASE("copies of no bytes do nothing and copies past the end are refused", "[device][buffer]") {
    const auto context = Context::create(choose_device());
    const Buffer none(context, 0, "nothing"), some = device_test::upload(context, numbers(4), "some");
    REQUIRE(none);  // kernels can take it
    CHECK(none.bytes() == 0);
    cl_int value = 7;
    CHECK_NOTHROW(context->write(none, 0, 0, nullptr, "writing"));
    CHECK_NOTHROW(context->read(some, 16, 0, nullptr, "reading"));
    CHECK_NOTHROW(context->copy(none, 0, some, 0, 0, "copying"));
    CHECK_NOTHROW(context->fill_zero(none, "clearing"));
    CHECK_FALSE(context->write_async(none, 0, 0, nullptr, {}, "writing").get());
    CHECK_FALSE(context->read_async(none, 0, 0, nullptr, {}, "reading").get());
    CHECK_THROWS_AS(context->write(none, 0, 4, &value, "writing"), lcl::InvalidArgument);
    CHECK_THROWS_AS(context->read(some, 16, 4, &value, "reading"), lcl::InvalidArgument);
    CHECK_THROWS_AS(context->copy(some, 0, some, 8, 12, "copying"), lcl::InvalidArgument);
    CHECK_THROWS_AS(context->write_async(some, static_cast<std::size_t>(-4), 8, &value, {}, "writing"), lcl::InvalidArgument);
    CHECK(value == 7);
    CHECK(download(*context, some) == numbers(4));
}

TEST_CASE("an asynchronous write starts after its event and not before", "[device][event]") {
    const auto context = Context::create(choose_device());
    const Buffer buffer = device_test::upload(context, numbers(1000), "numbers");
    const std::vector<cl_int> later = numbers(1000, 5000);
    Gate gate(*context);
    const Event written = context->write_async(buffer, 0, buffer.bytes(), later.data(), gate.event(), "writing");
    CHECK(download(*context, buffer) == numbers(1000));  // on the other queue, which does not wait
    CHECK(status_of(written) > CL_COMPLETE);
    gate.open();
    written.wait();
    CHECK(status_of(written) == CL_COMPLETE);
    CHECK(download(*context, buffer) == later);
}

TEST_CASE("a chain over both queues keeps its order: wait, kernels' copy, marker, asynchronous read", "[device][event]") {
    const auto context = Context::create(choose_device());
    const Buffer from = device_test::upload(context, numbers(1000), "from"), to = device_test::upload(context, numbers(1000, 70), "to");
    std::vector<cl_int> result(1000, -1);
    Gate gate(*context);
    context->wait_for({gate.event().get()});
    context->copy(from, 0, to, 0, from.bytes(), "copying");
    const Event copied = context->marker();
    const Event read = context->read_async(to, 0, to.bytes(), result.data(), copied, "reading");
    CHECK(status_of(copied) > CL_COMPLETE);
    CHECK(status_of(read) > CL_COMPLETE);
    CHECK(result == std::vector<cl_int>(1000, -1));
    gate.open();
    read.wait();
    CHECK(result == numbers(1000));
    context->finish();
}

TEST_CASE("kernels that wait for an asynchronous write see what it wrote", "[device][event]") {
    const auto context = Context::create(choose_device());
    const Buffer buffer(context, 4000, "numbers"), copy(context, 4000, "copy");
    const std::vector<cl_int> values = numbers(1000, 3);
    for (int round = 0; round < 20; ++round) {
        context->fill_zero(buffer, "clearing");
        const Event written = context->write_async(buffer, 0, 4000, values.data(), context->marker(), "writing");
        context->wait_for({written.get()});
        context->copy(buffer, 0, copy, 0, 4000, "copying");
        REQUIRE(download(*context, copy) == values);
    }
    CHECK_NOTHROW(context->wait_for({}));
}

TEST_CASE("events copy, move and are done when empty", "[device][event]") {
    const auto context = Context::create(choose_device());
    Event first = context->marker();
    const Event copy = first;
    CHECK(copy.get() == first.get());
    const Event moved = std::move(first);
    CHECK(moved.get() == copy.get());
    CHECK_FALSE(first.get());
    CHECK_NOTHROW(first.wait());
    CHECK(first.seconds() == 0);
    CHECK_NOTHROW(moved.wait());
    CHECK(status_of(copy) == CL_COMPLETE);
}

TEST_CASE("commands are timed with profiling and refuse to be without", "[device][event]") {
    const std::vector<char> data(16u << 20, 1);
    lcl::ContextOptions options;
    options.profiling = true;
    const auto timed = Context::create(choose_device(), options);
    const Buffer buffer(timed, data.size(), "data");
    const double seconds = timed->write_async(buffer, 0, data.size(), data.data(), {}, "writing").seconds();
    CHECK(seconds > 0);
    CHECK(seconds < 60);

    const auto untimed = Context::create(choose_device());
    const Buffer other(untimed, data.size(), "data");
    const Event event = untimed->write_async(other, 0, data.size(), data.data(), {}, "writing");
    CHECK(contains(error_of<lcl::DeviceError>([&] { event.seconds(); }), "CL_PROFILING_INFO_NOT_AVAILABLE (-7)"));
}

TEST_CASE("a launch of no work-items does nothing; one with too few arguments or an empty buffer is an error with the kernel's name", "[device][launch]") {
    const auto context = Context::create(choose_device());
    const cl_kernel kernel = context->kernel("transfer", "lcl_import_points");
    CHECK_FALSE(lcl::launch(*context, kernel, {0, 0}).get());
    CHECK(contains(error_of<lcl::InvalidArgument>([&] { lcl::launch(*context, kernel, {64, 64}, Buffer()); }), "argument 0 of lcl_import_points"));
    CHECK(contains(error_of<lcl::DeviceError>([&] { lcl::launch(*context, kernel, {64, 64}, cl_uint(1)); }), "lcl_import_points"));
    CHECK(contains(error_of<lcl::DeviceError>([&] { lcl::launch(*context, kernel, {64, 64}, 1.0); }), "setting argument 0 of lcl_import_points"));
}

TEST_CASE("an adopted context works on the caller's queue and memory and gives back what it took", "[device][adopt]") {
    const DeviceInfo device = choose_device();
    Caller caller(device);
    REQUIRE(caller.queue);
    const cl_uint references = caller.context_references();
    {
        const auto context = Context::adopt(caller.context, caller.queue);
        CHECK(context->queue() == caller.queue);
        CHECK(context->get() == caller.context);
        CHECK(context->transfer_queue() != caller.queue);
        CHECK(context->device().id == device.id);
        CHECK(context->device().index == -1);
        CHECK(context->device().name == device.name);
        CHECK(imports_rightly(*context, 3));

        const std::vector<cl_int> before = numbers(256), part = numbers(10, 900);
        REQUIRE(clEnqueueWriteBuffer(caller.queue, caller.memory, CL_TRUE, 0, 1024, before.data(), 0, nullptr, nullptr) == CL_SUCCESS);
        const Buffer borrowed(context, caller.memory, 12, 40);
        CHECK(borrowed.offset() == 12);
        CHECK(download(*context, borrowed) == numbers(10, 3));
        context->write(borrowed, 0, 40, part.data(), "writing");
        context->fill_zero(Buffer(context, caller.memory, 52, 7), "clearing");  // a size that is no multiple of 4
        CHECK(context->allocated_bytes() == 0);
        CHECK_THROWS_AS(context->write(borrowed, 4, 40, part.data(), "writing"), lcl::InvalidArgument);
    }
    CHECK(caller.context_references() == references);
    std::vector<cl_int> after(256);
    REQUIRE(clEnqueueReadBuffer(caller.queue, caller.memory, CL_TRUE, 0, 1024, after.data(), 0, nullptr, nullptr) == CL_SUCCESS);
    std::vector<cl_int> expected = numbers(256);
    for (int i = 0; i < 10; ++i) expected[3 + i] = 900 + i;
    expected[13] = 0;
    std::fill_n(reinterpret_cast<char*>(&expected[14]), 3, char(0));
    CHECK(after == expected);
}

TEST_CASE("adopt refuses an out-of-order queue, a null one and another context's", "[device][adopt]") {
    const DeviceInfo device = choose_device();
    const Caller unordered(device, CL_QUEUE_OUT_OF_ORDER_EXEC_MODE_ENABLE), ordered(device);
    if (unordered.queue) CHECK(contains(error_of<lcl::InvalidArgument>([&] { Context::adopt(unordered.context, unordered.queue); }), "out of order"));
    CHECK_THROWS_AS(Context::adopt(unordered.context, ordered.queue), lcl::InvalidArgument);
    CHECK_THROWS_AS(Context::adopt(ordered.context, nullptr), lcl::InvalidArgument);
    CHECK_THROWS_AS(Context::adopt(nullptr, ordered.queue), lcl::InvalidArgument);
    CHECK(ordered.context_references() == Caller(device).context_references());
}

TEST_CASE("a caller's memory is refused when null, too small or of another context", "[device][adopt]") {
    const DeviceInfo device = choose_device();
    const Caller caller(device), other(device);
    const auto context = Context::adopt(caller.context, caller.queue);
    CHECK_THROWS_AS(Buffer(context, nullptr, 0, 4), lcl::InvalidArgument);
    CHECK_THROWS_AS(Buffer(context, other.memory, 0, 4), lcl::InvalidArgument);
    const std::string sentence = error_of<lcl::InvalidArgument>([&] { Buffer(context, caller.memory, 1000, 25); });
    CHECK(contains(sentence, "1024 bytes, too few for 25 from byte 1000"));
    CHECK_THROWS_AS(Buffer(context, caller.memory, 1025, 0), lcl::InvalidArgument);
    CHECK_NOTHROW(Buffer(context, caller.memory, 1000, 24));
}

TEST_CASE("two threads with a context each use one device at once", "[device][thread]") {
    const DeviceInfo device = choose_device();
    std::atomic<int> right{0};
    std::vector<std::thread> threads;
    for (int i = 0; i < 2; ++i) threads.emplace_back([&] { right += imports_rightly(*Context::create(device), 50); });
    for (std::thread& thread : threads) thread.join();
    CHECK(right == 2);
}

TEST_CASE("all devices work at once, from one thread and from one thread each", "[device][thread]") {
    const std::vector<DeviceInfo> devices = devices_here();
    std::atomic<std::size_t> right{0};
    std::vector<std::thread> threads;
    for (const DeviceInfo& device : devices) threads.emplace_back([&right, device] { right += imports_rightly(*Context::create(device), 20); });
    for (std::thread& thread : threads) thread.join();
    CHECK(right == devices.size());

    // Every device has its commands before the first is waited for.
    std::vector<std::shared_ptr<Context>> contexts;
    std::vector<Buffer> from, to;
    for (const DeviceInfo& device : devices) {
        contexts.push_back(Context::create(device));
        from.push_back(device_test::upload(contexts.back(), numbers(1000, 10 * device.index), "from"));
        to.emplace_back(contexts.back(), 4000, "to");
    }
    std::vector<Event> done;
    for (std::size_t i = 0; i < contexts.size(); ++i) {
        contexts[i]->copy(from[i], 0, to[i], 0, 4000, "copying");
        done.push_back(contexts[i]->marker());
    }
    for (std::size_t i = 0; i < contexts.size(); ++i) {
        done[i].wait();
        CHECK(download(*contexts[i], to[i]) == numbers(1000, 10 * static_cast<cl_int>(i)));
    }
}

-- Wireshark dissector for the gyrolog protocol (firmware_protocol/SPEC.md) in the bulk transfers of a capture.
--
--   tshark -X lua_script:gyrolog.lua -r capture.pcapng -Y gyrolog
--
-- The package installs it where Wireshark finds it by itself. Without the package, copy it into the folder that
-- Help > About > Folders calls "Personal Lua Plugins". Binds itself to 1209:6779 and to 1fc9:0083, the id of older
-- firmware, when the capture holds the device descriptor; otherwise use "Decode As" on the USB device or product.

-- Installed and named on the command line as well: the first one holds.
if gyrolog_dissector_is_loaded then return end
gyrolog_dissector_is_loaded = true

local gyrolog = Proto("gyrolog", "gyrolog sensor stream")

local type_names = {
    [0x01] = "HELLO", [0x02] = "CONFIG", [0x03] = "SAMPLES", [0x04] = "STATUS", [0x05] = "EVENT", [0x06] = "REPLY",
    [0x81] = "GET_HELLO", [0x82] = "CONFIGURE", [0x83] = "START", [0x84] = "STOP", [0x85] = "GET_STATUS",
}
local event_names = {
    [1] = "started", [2] = "stopped", [3] = "sensor FIFO overflow", [4] = "bus error", [5] = "ring overflow",
    [6] = "sensor fault", [7] = "text", [8] = "data-ready silent",
}
local result_names = {
    [0] = "ok", [1] = "unknown command", [2] = "bad length", [3] = "bad value", [4] = "sensor fault",
}
local reset_names = {
    [0] = "unknown", [1] = "power on", [2] = "pin", [3] = "watchdog", [4] = "brown-out", [5] = "software",
}

local fields = {}
local function field(kind, name, label, ...)
    fields[name] = ProtoField[kind]("gyrolog." .. name, label, ...)
    return fields[name]
end

local version = field("uint8", "version", "Version")
local frame_type = field("uint8", "type", "Type", base.HEX, type_names)
local flags = field("uint16", "flags", "Flags", base.HEX)
local flag_bits = {
    field("bool", "flags.sensor_fifo_overflow", "Sensor FIFO overflow", 16, nil, 0x0001),
    field("bool", "flags.bus_error", "Bus error", 16, nil, 0x0002),
    field("bool", "flags.ring_overflow", "Ring overflow", 16, nil, 0x0004),
    field("bool", "flags.first_after_start", "First after start", 16, nil, 0x0008),
    field("bool", "flags.time_discontinuity", "Time discontinuity", 16, nil, 0x0010),
    field("bool", "flags.saturated", "Saturated", 16, nil, 0x0020),
    field("bool", "flags.data_ready_silent", "Data-ready silent", 16, nil, 0x0040),
}
local sequence = field("uint32", "sequence", "Sequence")
local crc = field("uint32", "crc", "Checksum", base.HEX)
local refused = field("string", "refused", "Refused")
local sample = field("string", "sample", "Sample")

-- Tables of SPEC.md section 4: { name, label, kind, bytes, ... } in their order on the wire; "skip" is reserved.
local messages = {
    [0x01] = {
        { "hello.protocol_major", "Protocol major", "uint8", 1 },
        { "hello.protocol_minor", "Protocol minor", "uint8", 1 },
        { "hello.tick_bits", "Tick bits", "uint8", 1 },
        { "hello.who_am_i", "WHO_AM_I", "uint8", 1, base.HEX },
        { "hello.tick_hz", "Tick rate (Hz)", "uint32", 4 },
        { "hello.boot_id", "Boot id", "uint32", 4, base.HEX },
        { "hello.reset_cause", "Reset cause", "uint8", 1, base.DEC, reset_names },
        { "skip", 3 },
        { "hello.uid", "Unique number", "bytes", 16 },
        { "hello.firmware", "Firmware", "stringz", 24 },
        { "hello.sensor", "Sensor", "stringz", 16 },
    },
    [0x02] = {
        { "config.generation", "Generation", "uint16", 2 },
        { "config.layout", "Layout", "uint8", 1, base.HEX },
        { "config.samples_per_frame", "Samples per frame", "uint8", 1 },
        { "config.rate_mHz", "Rate (mHz)", "uint32", 4 },
        { "config.gyro_full_scale_dps", "Gyro full scale (deg/s)", "uint16", 2 },
        { "config.accel_full_scale_g", "Accelerometer full scale (g)", "uint16", 2 },
        { "config.dlpf_hz", "Filter (Hz, 0: bypassed)", "uint16", 2 },
        { "config.decimation", "Decimation", "uint16", 2 },
        { "config.gyro_ndps_per_lsb", "Gyro scale (ndeg/s per count)", "uint32", 4 },
        { "config.accel_pg_per_lsb", "Accelerometer scale (pg per count)", "uint32", 4 },
        { "config.temp_nC_per_lsb", "Temperature scale (nK per count)", "uint32", 4 },
        { "config.temp_offset_mC", "Temperature at count 0 (mdegC)", "int32", 4 },
        { "config.registers", "Registers", "bytes", 8 },
    },
    [0x03] = {
        { "samples.first_ticks", "First ticks", "uint64", 8 },
        { "samples.first_index", "First index", "uint64", 8 },
        { "samples.config_generation", "Configuration", "uint16", 2 },
        { "samples.temperature", "Temperature (count)", "int16", 2 },
        { "samples.lost_samples", "Lost on the device", "uint32", 4 },
        { "samples.count", "Count", "uint8", 1 },
        { "samples.layout", "Layout", "uint8", 1, base.HEX },
        { "skip", 2 },
    },
    [0x04] = {
        { "status.ticks", "Ticks", "uint64", 8 },
        { "status.next_index", "Next index", "uint64", 8 },
        { "status.lost_samples", "Lost samples", "uint32", 4 },
        { "status.lost_frames", "Lost frames", "uint32", 4 },
        { "status.ring_bytes", "Ring (byte)", "uint32", 4 },
        { "status.ring_high_water_bytes", "Ring high water (byte)", "uint32", 4 },
        { "status.usb_frame_number", "USB frame number", "uint32", 4 },
        { "status.fifo_overflows", "FIFO overflows", "uint32", 4 },
        { "status.bus_errors", "Bus errors", "uint32", 4 },
        { "status.temperature", "Temperature (count)", "int16", 2 },
        { "status.streaming", "Streaming", "uint8", 1 },
        { "status.reset_cause", "Reset cause", "uint8", 1, base.DEC, reset_names },
    },
    [0x05] = {
        { "event.ticks", "Ticks", "uint64", 8 },
        { "event.index", "Index", "uint64", 8 },
        { "event.code", "Code", "uint16", 2, base.DEC, event_names },
        { "event.text_bytes", "Text length (byte)", "uint8", 1 },
        { "skip", 1 },
        { "event.value", "Value", "int32", 4 },
    },
    [0x06] = {
        { "reply.command_sequence", "Command sequence", "uint32", 4 },
        { "reply.command_type", "Command", "uint8", 1, base.HEX, type_names },
        { "reply.result", "Result", "uint8", 1, base.DEC, result_names },
    },
    [0x82] = {
        { "configure.rate_mHz", "Rate (mHz)", "uint32", 4 },
        { "configure.gyro_full_scale_dps", "Gyro full scale (deg/s)", "uint16", 2 },
        { "configure.accel_full_scale_g", "Accelerometer full scale (g)", "uint16", 2 },
        { "configure.dlpf_hz", "Filter (Hz)", "uint16", 2 },
        { "configure.layout", "Layout", "uint8", 1, base.HEX },
        { "configure.samples_per_frame", "Samples per frame", "uint8", 1 },
    },
}
local event_text = field("string", "event.text", "Text")

for _, rows in pairs(messages) do
    for _, row in ipairs(rows) do
        if row[1] ~= "skip" then field(row[3], row[1], row[2], row[5], row[6]) end
    end
end

local all = {}
for _, one in pairs(fields) do all[#all + 1] = one end
gyrolog.fields = all

local bad_frame = ProtoExpert.new("gyrolog.refused.expert", "Bytes that are no frame", expert.group.MALFORMED,
    expert.severity.WARN)
gyrolog.experts = { bad_frame }

-- Section 3: CRC-32, reflected.
local crc_table = {}
for byte = 0, 255 do
    local remainder = byte
    for _ = 1, 8 do
        local odd = bit.band(remainder, 1) == 1
        remainder = bit.rshift(remainder, 1)
        if odd then remainder = bit.bxor(remainder, 0xEDB88320) end
    end
    crc_table[byte] = remainder
end

local function crc32(text, size)
    local remainder = bit.bnot(0)
    for i = 1, size do
        local index = bit.band(bit.bxor(remainder, text:byte(i)), 0xFF)
        remainder = bit.bxor(bit.rshift(remainder, 8), crc_table[index])
    end
    return bit.bnot(remainder) % 0x100000000
end

-- Section 2. The body, or nil and the reason.
local function uncobs(form)
    local parts, at, previous = {}, 1, 0
    while at <= #form do
        local code = form:byte(at)
        if at + code - 1 > #form then return nil, "bad_cobs" end
        if previous == 0xFF and code == 1 and at == #form then return nil, "bad_cobs" end
        parts[#parts + 1] = form:sub(at + 1, at + code - 1)
        at = at + code
        if code ~= 0xFF and at <= #form then parts[#parts + 1] = "\0" end
        previous = code
    end
    return table.concat(parts)
end

-- Rule 1.7 as far as the frame goes.
local function judge(form)
    local body, reason = uncobs(form)
    if not body then return nil, reason end
    if #body < 12 or #body > 1016 then return nil, "bad_length" end
    local a, b, c, d = body:byte(-4, -1)
    if crc32(body, #body - 4) ~= a + b * 2 ^ 8 + c * 2 ^ 16 + d * 2 ^ 24 then return nil, "bad_crc" end
    if body:byte(1) ~= 1 then return nil, "bad_version" end
    return body
end

local function add_rows(tree, rows, payload)
    local at = 0
    for _, row in ipairs(rows) do
        local bytes = row[1] == "skip" and row[2] or row[4]
        if at + bytes > payload:len() then return at end
        if row[1] ~= "skip" then
            local one = fields[row[1]]
            if row[3] == "bytes" or row[3] == "stringz" then
                tree:add(one, payload(at, bytes))
            else
                tree:add_le(one, payload(at, bytes))
            end
        end
        at = at + bytes
    end
    return at
end

local function add_samples(tree, payload, at)
    local count, layout = payload(24, 1):uint(), payload(25, 1):uint()
    local words = 3 * (layout % 2) + 3 * (math.floor(layout / 2) % 2) + math.floor(layout / 4) % 2
    for i = 0, count - 1 do
        if words == 0 or at + 2 * words > payload:len() then return end
        local values = {}
        for k = 0, words - 1 do values[#values + 1] = payload(at + 2 * k, 2):le_int() end
        tree:add(sample, payload(at, 2 * words), string.format("%d: %s", i, table.concat(values, " ")))
        at = at + 2 * words
    end
end

local function add_frame(tree, body)
    local bytes = ByteArray.new(body, true):tvb("gyrolog frame")
    local kind = body:byte(2)
    local name = type_names[kind] or string.format("type %02x", kind)
    local number = bytes(4, 4):le_uint()
    local branch = tree:add(gyrolog, bytes(), string.format("gyrolog %s, sequence %d", name, number))
    branch:add(version, bytes(0, 1))
    branch:add(frame_type, bytes(1, 1))
    local flag_branch = branch:add_le(flags, bytes(2, 2))
    for _, one in ipairs(flag_bits) do flag_branch:add_le(one, bytes(2, 2)) end
    branch:add_le(sequence, bytes(4, 4))
    if #body > 12 and messages[kind] then
        local payload = bytes(8, #body - 12):tvb()
        local at = add_rows(branch, messages[kind], payload)
        if kind == 0x03 and at == 28 then add_samples(branch, payload, at) end
        if kind == 0x05 and at == 24 then
            local size = math.min(payload(18, 1):uint(), payload:len() - 24)
            if size > 0 then branch:add(event_text, payload(24, size)) end
        end
    end
    branch:add_le(crc, bytes(#body - 4, 4))
    return name
end

-- Frames run across transfers. `open_forms` is what each endpoint's last transfer left unfinished; `begun` remembers
-- for each packet what it found there, because Wireshark dissects packets again, and in any order.
local open_forms, begun = {}, {}

function gyrolog.init()
    open_forms, begun = {}, {}
end

local transfer_type = Field.new("usb.transfer_type")
local endpoint = Field.new("usb.endpoint_address")
local device = Field.new("usb.device_address")
local bus = Field.new("usb.bus_id")

local function stream_of()
    return string.format("%s.%s.%s", tostring(bus()), tostring(device()), tostring(endpoint()))
end

function gyrolog.dissector(buffer, pinfo, tree)
    local kind = transfer_type()
    if not kind or kind.value ~= 3 or buffer:len() == 0 then return 0 end
    local stream = stream_of()
    if not pinfo.visited then begun[pinfo.number] = open_forms[stream] or "" end
    local text = (begun[pinfo.number] or "") .. buffer:raw()

    pinfo.cols.protocol = "gyrolog"
    local branch = tree:add(gyrolog, buffer())
    local names, at = {}, 1
    while true do
        local delimiter = text:find("\0", at, true)
        if not delimiter then break end
        if delimiter > at then
            local body, reason = judge(text:sub(at, delimiter - 1))
            if body then
                names[#names + 1] = add_frame(branch, body)
            else
                branch:add(refused, buffer(), string.format("%d bytes: %s", delimiter - at, reason))
                branch:add_proto_expert_info(bad_frame)
                names[#names + 1] = reason
            end
        end
        at = delimiter + 1
    end
    if not pinfo.visited then
        -- What outgrows a frame can become none: its length is enough to say so.
        open_forms[stream] = text:sub(at, at + 1020)
    end
    pinfo.cols.info = #names > 0 and table.concat(names, ", ") or "part of a frame"
    return buffer:len()
end

local products = DissectorTable.get("usb.product")
for _, id in ipairs({ 0x12096779, 0x1fc90083 }) do products:add(id, gyrolog) end
for _, name in ipairs({ "usb.product", "usb.device" }) do
    local found, table_of = pcall(DissectorTable.get, name)
    if found and table_of then pcall(table_of.add_for_decode_as, table_of, gyrolog) end
end

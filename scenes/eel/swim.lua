-- The body wave of an anguilliform swimmer (Carling, Williams & Bowtell 1998): the midline at s m from the
-- nose is 0.125 L (s/L + 0.03125)/1.03125 sin 2 pi (s/L - t/T) aside. It keeps its length.
local p = params
local L, T = p.length, p.period
local PIECES = 200

local function aside(s, t)
    return p.amplitude*L*(s/L + 0.03125)/1.03125*math.sin(2*math.pi*(s/L - t/T))
end

-- The amplitude rises within the first period.
local function grown(t)
    return t >= T and 1 or 0.5*(1 - math.cos(math.pi*t/T))
end

local function slope(s, t)
    local h = 1e-5*L
    return (aside(s + h, t) - aside(s - h, t))/(2*h)
end

-- x of the midline at PIECES + 1 places, by Simpson's rule, for one time.
local line, when = {}, nil

local function draw(t)
    local g, d = grown(t), L/PIECES
    local function along(s)
        local v = g*slope(s, t)
        return math.sqrt(1 - v*v)
    end
    line[0] = 0
    for k = 1, PIECES do
        local s = (k - 1)*d
        line[k] = line[k - 1] + d/6*(along(s) + 4*along(s + 0.5*d) + along(s + d))
    end
    when = t
end

function deform(x, y, z, t)
    if when ~= t then draw(t) end
    local s = math.min(math.max(x - p.nose[1], 0), L)
    local k = math.min(math.floor(s/L*PIECES), PIECES - 1)
    local rest, g = s - k*L/PIECES, grown(t)
    local v = g*slope(s, t)
    local c = math.sqrt(1 - v*v)
    -- From the node before, by the midpoint rule; then across by the normal (-v, c).
    local w = g*slope(s - 0.5*rest, t)
    local mid = line[k] + rest*math.sqrt(1 - w*w)
    local across = y - p.nose[2]
    return p.nose[1] + mid - v*across, p.nose[2] + g*aside(s, t) + c*across, z
end

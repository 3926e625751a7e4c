-- A standing wave of small amplitude at the moment when its surface is level.
local p, g = params, 9.81
local k = 2*math.pi/p.length

local function sinh(x) return (math.exp(x) - math.exp(-x))/2 end
local function cosh(x) return (math.exp(x) + math.exp(-x))/2 end

function velocity(x, y, z)
    local top = k*p.depth
    local speed = p.amplitude*math.sqrt(g*k*sinh(top)/cosh(top))/sinh(top)
    return -speed*cosh(k*y)*math.sin(k*x), speed*sinh(k*y)*math.cos(k*x), 0
end

-- The Taylor-Green vortex at the start.
local k, speed = 2*math.pi/params.side, params.speed

function velocity(x, y, z)
    return speed*math.sin(k*x)*math.cos(k*y), -speed*math.cos(k*x)*math.sin(k*y), 0
end

function velocity(x, y, z)
    local k = 5*math.pi
    return 0.1*math.sin(k*x)*math.cos(k*y), -0.1*math.cos(k*x)*math.sin(k*y), 0
end

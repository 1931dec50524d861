// ardrone-autonomy, unmodified: flies a mission with its own estimator and controller.
const autonomy = require('ardrone-autonomy');

const mission = autonomy.createMission({ ip: '127.0.0.1' });
let last = null;
mission.control().on('controlData', (data) => { last = data.state; });
const fail = setTimeout(() => { console.error('no end within 60 s', last); process.exit(1); }, 60000);
mission.takeoff().zero().altitude(1).forward(1).cw(90).forward(1).hover(300).land();
mission.run((error) => {
  clearTimeout(fail);
  console.log('mission ended', error || 'well', JSON.stringify(last));
  const near = last && Math.abs(last.x - 1) < 0.5 && Math.abs(last.y - 1) < 0.5;
  process.exit(!error && near ? 0 : 1);
});

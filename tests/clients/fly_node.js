// node-ar-drone, unmodified: takes off, climbs, turns, lands, and watches navdata meanwhile.
const arDrone = require('ar-drone');

const client = arDrone.createClient({ ip: '127.0.0.1' });
const seen = { packets: 0, highest: 0, turned: 0 };
let start = null;
client.config('general:navdata_demo', process.argv[2] === 'full' ? 'FALSE' : 'TRUE');
client.on('navdata', (navdata) => {
  if (!navdata.demo) return;
  seen.packets += 1;
  seen.highest = Math.max(seen.highest, navdata.demo.altitude);
  const yaw = navdata.demo.rotation.yaw;
  if (start === null) start = yaw;
  seen.turned = Math.max(seen.turned, Math.abs(yaw - start));
});
const fail = setTimeout(() => { console.error('no end within 30 s', seen); process.exit(1); }, 30000);
client.takeoff(() => {
  console.log('has taken off');
  client.after(500, function () { this.up(0.5); })
    .after(1500, function () { this.stop(); this.clockwise(0.5); })
    .after(1000, function () { this.stop(); this.front(0.1); })
    .after(1000, function () { this.stop(); })
    .after(500, function () {
      this.land(() => {
        clearTimeout(fail);
        console.log('has landed', seen);
        const flown = seen.packets > 60 && seen.highest > 1.0 && seen.turned > 20;
        process.exit(flown ? 0 : 1);
      });
    });
});
